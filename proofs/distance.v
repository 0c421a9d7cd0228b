(** How far masses and parameters are from the optimum, from how far the objective is. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem kkt duality.

Section Distance.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m t : nat -> K).

  (** Claim C14. The gap is at least the square of the difference, in the terms of the objective. *)
  Theorem gap_bounds_the_difference p m t :
    well_formed p -> kkt p m -> nonnegative p t ->
    curvature p (fun k => Phi p t k - Phi p m k) +
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. rewrite (objective_expands p m t). apply le_of_sub.
    match goal with |- 0 <= ?a + ?b + ?c + ?d - ?a - (?c + ?d) =>
      replace (a + b + c + d - a - (c + d)) with b by ring end.
    now apply kkt_slope.
  Qed.

  Lemma gap_bounds_the_spread p m t :
    well_formed p -> kkt p m -> nonnegative p t ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. eapply le_trans; [| now apply gap_bounds_the_difference].
    match goal with |- ?b <= ?a + ?b => replace b with (0 + b) at 1 by ring end.
    apply le_add; [now apply curvature_nonneg | apply le_refl].
  Qed.

  (** Claim C14. (Phi_k - Phi*_k)^2 <= gap / lambda times the sum of U_kj^2 V_j. *)
  Theorem gap_bounds_parameters p m t k :
    well_formed p -> kkt p m -> nonnegative p t ->
    lambda p * ((Phi p t k - Phi p m k) * (Phi p t k - Phi p m k)) <=
    sum (shapes p) (fun j => U p k j * U p k j * V p j) * (objective p t - objective p m).
  Proof.
    intros wf h ht. pose proof (gap_bounds_the_spread p m t wf h ht) as spread.
    set (D := sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j)) in *.
    set (S := sum (shapes p) (fun j => U p k j * U p k j * V p j)).
    assert (volume : forall j, (j < shapes p)%nat -> 0 < V p j) by (intros; now apply wf).
    assert (S_nonneg : 0 <= S).
    { apply sum_nonneg. intros j hj.
      apply mul_nonneg; [apply square_nonneg | now apply lt_le, volume]. }
    assert (difference : Phi p t k - Phi p m k = dot (shapes p) (fun j => t j - m j) (U p k)).
    { unfold Phi, dot. rewrite <- sum_sub. apply sum_ext. intros. ring. }
    pose proof (cauchy_schwarz (shapes p) (V p) (fun j => t j - m j) (U p k) volume) as cs.
    rewrite <- difference in cs. fold D in cs.
    assert (same : sum (shapes p) (fun j => V p j * (U p k j * U p k j)) = S).
    { apply sum_ext. intros. ring. }
    rewrite same in cs.
    apply (le_trans _ (lambda p * (D * S))); [apply le_scale; [apply wf | exact cs] |].
    replace (lambda p * (D * S)) with (S * (lambda p * D)) by ring. now apply le_scale.
  Qed.

  (** Claim C14. (m_j - m*_j)^2 <= gap V_j / lambda. *)
  Theorem gap_bounds_masses p m t j :
    well_formed p -> kkt p m -> nonnegative p t -> (j < shapes p)%nat ->
    lambda p * ((t j - m j) * (t j - m j)) <= V p j * (objective p t - objective p m).
  Proof.
    intros wf h ht hj.
    pose proof (gap_bounds_the_spread p m t wf h ht) as spread.
    assert (v : 0 < V p j) by now apply wf.
    apply (le_trans _ (V p j * (lambda p * ((t j - m j) * (t j - m j) / V p j)))).
    - match goal with |- ?a <= ?b => replace b with a by (field; now apply pos_nonzero) end.
      apply le_refl.
    - apply le_scale; [now apply lt_le |]. eapply le_trans; [| exact spread].
      apply le_scale; [apply wf |].
      rewrite <- (sum_indicator (shapes p) j (fun i => (t i - m i) * (t i - m i) / V p i))
        by exact hj.
      apply sum_le. intros i hi. destruct (j =? i).
      + match goal with |- ?a <= ?b => replace a with b by ring end. apply le_refl.
      + match goal with |- ?a <= _ => replace a with (0 : K) by ring end.
        apply div_nonneg; [apply square_nonneg | now apply wf].
  Qed.
End Distance.
