(** How far masses and parameters are from the optimum, from how far the objective is. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem kkt kkt_necessary certificate duality.

Section Distance.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m t : nat -> K).

  (** Where the objective does not fall from m toward t, it is higher there by at least the square of
      the difference, in its own terms. *)
  Lemma slope_bounds_the_difference p m t :
    0 <= sum (shapes p) (fun j => gradient p m j * (t j - m j)) ->
    curvature p (fun k => Phi p t k - Phi p m k) +
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros slope. rewrite (objective_expands p m t). apply le_of_sub.
    match goal with |- 0 <= ?a + ?b + ?c + ?d - ?a - (?c + ?d) =>
      replace (a + b + c + d - a - (c + d)) with b by ring end.
    exact slope.
  Qed.

  Lemma difference_bounds_the_spread p m t gap :
    well_formed p ->
    curvature p (fun k => Phi p t k - Phi p m k) +
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <= gap ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <= gap.
  Proof.
    intros wf difference. eapply le_trans; [| exact difference].
    match goal with |- ?b <= ?a + ?b => replace b with (0 + b) at 1 by ring end.
    apply le_add; [now apply curvature_nonneg | apply le_refl].
  Qed.

  (** Claim C14. The gap is at least the square of the difference, in the terms of the objective. *)
  Theorem gap_bounds_the_difference p m t :
    well_formed p -> kkt p m -> nonnegative p t ->
    curvature p (fun k => Phi p t k - Phi p m k) +
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. now apply slope_bounds_the_difference, kkt_slope.
  Qed.

  Lemma gap_bounds_the_spread p m t :
    well_formed p -> kkt p m -> nonnegative p t ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. now apply difference_bounds_the_spread, gap_bounds_the_difference.
  Qed.

  Lemma spread_bounds_parameters p m t k gap :
    well_formed p ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <= gap ->
    lambda p * ((Phi p t k - Phi p m k) * (Phi p t k - Phi p m k)) <=
    sum (shapes p) (fun j => U p k j * U p k j * V p j) * gap.
  Proof.
    intros wf spread.
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

  Lemma spread_bounds_masses p m t j gap :
    well_formed p -> (j < shapes p)%nat ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <= gap ->
    lambda p * ((t j - m j) * (t j - m j)) <= V p j * gap.
  Proof.
    intros wf hj spread.
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

  (** Claim C14. (Phi_k - Phi*_k)^2 <= gap / lambda times the sum of U_kj^2 V_j. *)
  Theorem gap_bounds_parameters p m t k :
    well_formed p -> kkt p m -> nonnegative p t ->
    lambda p * ((Phi p t k - Phi p m k) * (Phi p t k - Phi p m k)) <=
    sum (shapes p) (fun j => U p k j * U p k j * V p j) * (objective p t - objective p m).
  Proof.
    intros wf h ht. now apply spread_bounds_parameters, gap_bounds_the_spread.
  Qed.

  (** Claim C14. (m_j - m*_j)^2 <= gap V_j / lambda. *)
  Theorem gap_bounds_masses p m t j :
    well_formed p -> kkt p m -> nonnegative p t -> (j < shapes p)%nat ->
    lambda p * ((t j - m j) * (t j - m j)) <= V p j * (objective p t - objective p m).
  Proof.
    intros wf h ht hj. now apply spread_bounds_masses, gap_bounds_the_spread.
  Qed.

  (** The optimum of at most a mass M, which may be less than the masses would have without. *)
  Definition best_within p M m : Prop :=
    within p M m /\ forall t, within p M t -> objective p m <= objective p t.

  (** From there no allowed step goes down: the objective along it is a parabola. *)
  Lemma best_within_slope p M m t :
    well_formed p -> best_within p M m -> within p M t ->
    0 <= sum (shapes p) (fun j => gradient p m j * (t j - m j)).
  Proof.
    intros wf [[hm total_m] best] [ht total_t].
    set (z := sum (shapes p) (fun j => gradient p m j * (t j - m j))).
    set (c := curvature p (fun k => Phi p t k - Phi p m k) +
              lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j)).
    assert (hc : 0 <= c).
    { apply add_nonneg; [now apply curvature_nonneg |].
      apply mul_nonneg; [apply wf | now apply spread_nonneg]. }
    apply (parabola z c 1 hc one_pos). intros s hs hs1.
    pose (on_the_way := fun j => m j + s * (t j - m j)).
    assert (between : forall a b : K, a + s * (b - a) = (1 - s) * a + s * b) by (intros; ring).
    pose proof (sub_nonneg _ _ hs1) as rest.
    assert (allowed : within p M on_the_way).
    { split.
      - intros j hj. unfold on_the_way. rewrite between.
        apply add_nonneg; apply mul_nonneg; auto.
      - assert (total : sum (shapes p) on_the_way =
                        (1 - s) * sum (shapes p) m + s * sum (shapes p) t).
        { rewrite <- !sum_scale, <- sum_add. apply sum_ext. intros j _. apply between. }
        rewrite total. replace M with ((1 - s) * M + s * M) by ring.
        apply le_add; now apply le_scale. }
    specialize (best _ allowed). rewrite (objective_expands p m on_the_way) in best.
    assert (slope : sum (shapes p) (fun j => gradient p m j * (on_the_way j - m j)) = z * s).
    { unfold z. transitivity (s * sum (shapes p) (fun j => gradient p m j * (t j - m j)));
        [| ring].
      rewrite <- sum_scale. apply sum_ext. intros j _. unfold on_the_way. ring. }
    assert (bend : curvature p (fun k => Phi p on_the_way k - Phi p m k) =
                   s * s * curvature p (fun k => Phi p t k - Phi p m k)).
    { unfold curvature. rewrite <- sum_scale. apply sum_ext. intros i _. cbv zeta.
      assert (row : sum (parameters p) (fun k => Y p i k * (Phi p on_the_way k - Phi p m k)) =
                    s * sum (parameters p) (fun k => Y p i k * (Phi p t k - Phi p m k))).
      { rewrite <- sum_scale. apply sum_ext. intros k _.
        assert (step : Phi p on_the_way k - Phi p m k = s * (Phi p t k - Phi p m k)).
        { unfold Phi. rewrite <- !sum_sub, <- sum_scale. apply sum_ext. intros j _.
          unfold on_the_way. ring. }
        rewrite step. ring. }
      rewrite row. ring. }
    assert (apart : sum (shapes p) (fun j =>
                      (on_the_way j - m j) * (on_the_way j - m j) / V p j) =
                    s * s * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j)).
    { rewrite <- sum_scale. apply sum_ext. intros j _. unfold on_the_way. rewrite !div_mul. ring. }
    rewrite slope, bend, apart in best. apply sub_nonneg in best.
    match type of best with 0 <= ?a => match goal with |- 0 <= ?b =>
      replace b with a by (unfold c; ring) end end. exact best.
  Qed.

  (** Claim C14. The same of the optimum of at most a mass M, whether that holds it back or not. *)
  Theorem gap_at_most_the_mass_bounds_the_difference p M m t :
    well_formed p -> best_within p M m -> within p M t ->
    curvature p (fun k => Phi p t k - Phi p m k) +
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. now apply slope_bounds_the_difference, (best_within_slope p M).
  Qed.

  Lemma gap_at_most_the_mass_bounds_the_spread p M m t :
    well_formed p -> best_within p M m -> within p M t ->
    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) <=
    objective p t - objective p m.
  Proof.
    intros wf h ht. apply difference_bounds_the_spread; [exact wf |].
    now apply (gap_at_most_the_mass_bounds_the_difference p M).
  Qed.

  (** Claim C14. ... and so of its parameters *)
  Theorem gap_at_most_the_mass_bounds_parameters p M m t k :
    well_formed p -> best_within p M m -> within p M t ->
    lambda p * ((Phi p t k - Phi p m k) * (Phi p t k - Phi p m k)) <=
    sum (shapes p) (fun j => U p k j * U p k j * V p j) * (objective p t - objective p m).
  Proof.
    intros wf h ht. apply spread_bounds_parameters; [exact wf |].
    now apply (gap_at_most_the_mass_bounds_the_spread p M).
  Qed.

  (** Claim C14. ... and masses. *)
  Theorem gap_at_most_the_mass_bounds_masses p M m t j :
    well_formed p -> best_within p M m -> within p M t -> (j < shapes p)%nat ->
    lambda p * ((t j - m j) * (t j - m j)) <= V p j * (objective p t - objective p m).
  Proof.
    intros wf h ht hj. apply spread_bounds_masses; [exact wf | exact hj |].
    now apply (gap_at_most_the_mass_bounds_the_spread p M).
  Qed.
End Distance.
