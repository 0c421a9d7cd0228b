(** When masses are the optimum of the mass problem, and the only one. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem.

Section Kkt.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m t : nat -> K).

  (** Nonnegative masses, nonnegative slopes, and no slope at a shape that has mass. *)
  Definition kkt p m : Prop :=
    nonnegative p m /\
    forall j, (j < shapes p)%nat -> 0 <= gradient p m j /\ m j * gradient p m j = 0.

  Lemma kkt_slope p m t :
    kkt p m -> nonnegative p t -> 0 <= sum (shapes p) (fun j => gradient p m j * (t j - m j)).
  Proof.
    intros [_ z] ht. apply sum_nonneg. intros j hj. destruct (z j hj) as [zj comp].
    replace (gradient p m j * (t j - m j)) with
      (gradient p m j * t j - m j * gradient p m j) by ring.
    rewrite comp. replace (gradient p m j * t j - 0) with (gradient p m j * t j) by ring.
    apply mul_nonneg; [exact zj | now apply ht].
  Qed.

  (** Claim C3. The KKT conditions suffice. *)
  Theorem kkt_suffices p m : well_formed p -> kkt p m -> optimal p m.
  Proof.
    intros wf h. split; [apply h |]. intros t ht.
    apply le_sub. rewrite (objective_expands p m t).
    match goal with |- 0 <= ?a + ?b + ?c + ?d - ?a =>
      replace (a + b + c + d - a) with (b + c + d) by ring end.
    apply add_nonneg; [apply add_nonneg |].
    - now apply kkt_slope.
    - now apply curvature_nonneg.
    - apply mul_nonneg; [apply wf | now apply spread_nonneg].
  Qed.

  Lemma inv_nonzero_of_volume p j : well_formed p -> (j < shapes p)%nat -> inv (V p j) <> 0.
  Proof. intros wf hj. apply inv_nonzero, pos_nonzero, wf, hj. Qed.

  (** Equal density terms of a difference: no difference. *)
  Lemma no_spread p m t :
    well_formed p -> sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j) = 0 ->
    forall j, (j < shapes p)%nat -> t j = m j.
  Proof.
    intros wf e j hj.
    assert (zero : (t j - m j) * (t j - m j) / V p j = 0).
    { apply (sum_nonneg_zero (shapes p) (fun k => (t k - m k) * (t k - m k) / V p k));
        [| exact e | exact hj].
      intros k hk. apply div_nonneg; [apply square_nonneg | now apply wf]. }
    rewrite div_mul in zero. destruct (mul_zero _ _ zero) as [d | no].
    - replace (t j) with (t j - m j + m j) by ring. rewrite (square_zero _ d). ring.
    - now destruct (inv_nonzero_of_volume p j wf hj).
  Qed.

  (** Claim C13. With the density term two optima have the same masses. No rank is asked of Y U. *)
  Theorem optimum_is_unique p m t :
    well_formed p -> 0 < lambda p -> optimal p m -> optimal p t ->
    forall j, (j < shapes p)%nat -> t j = m j.
  Proof.
    intros wf positive [hm bm] [ht bt].
    pose (half := inv (2 : K)).
    pose (c := fun j => half * (m j + t j)).
    assert (two : half * 2 = 1) by (unfold half; field; apply pos_nonzero, two_pos).
    assert (hc : nonnegative p c).
    { intros j hj. apply mul_nonneg; [apply inv_nonneg, two_pos |].
      apply add_nonneg; [now apply hm | now apply ht]. }
    (* From the middle c, f(m) + f(t) is 2 f(c) and terms that are never negative. *)
    pose proof (objective_expands p c m) as em. pose proof (objective_expands p c t) as et.
    pose proof (bm c hc) as lm. pose proof (bt c hc) as lt'.
    assert (back : sum (shapes p) (fun j => gradient p c j * (m j - c j)) =
                   - sum (shapes p) (fun j => gradient p c j * (t j - c j))).
    { transitivity (sum (shapes p) (fun j => - (1) * (gradient p c j * (t j - c j)))).
      2: { rewrite sum_scale. ring. }
      apply sum_ext. intros j _. unfold c.
      replace (m j) with (half * 2 * m j) at 1 by (rewrite two; ring).
      replace (t j) with (half * 2 * t j) at 2 by (rewrite two; ring). ring. }
    pose proof (curvature_nonneg p (fun k => Phi p m k - Phi p c k) wf) as cm.
    pose proof (curvature_nonneg p (fun k => Phi p t k - Phi p c k) wf) as ct.
    pose proof (mul_nonneg _ _ (lt_le _ _ positive) (spread_nonneg p c m wf)) as sm.
    pose proof (mul_nonneg _ _ (lt_le _ _ positive) (spread_nonneg p c t wf)) as st.
    apply le_sub in lm. apply le_sub in lt'. rewrite em in lm. rewrite et in lt'.
    rewrite back in lm.
    revert lm lt' cm ct sm st.
    generalize (sum (shapes p) (fun j => gradient p c j * (t j - c j))).
    generalize (curvature p (fun k => Phi p m k - Phi p c k)).
    generalize (curvature p (fun k => Phi p t k - Phi p c k)).
    generalize (objective p c).
    set (A := sum (shapes p) (fun j => (m j - c j) * (m j - c j) / V p j)).
    set (B := sum (shapes p) (fun j => (t j - c j) * (t j - c j) / V p j)).
    intros f x y s lm lt' cm ct sm st.
    assert (sum0 : lambda p * A + (lambda p * B + (x + y)) = 0).
    { apply le_antisym.
      - apply le_sub. replace (0 - (lambda p * A + (lambda p * B + (x + y)))) with
          (f - (f + - s + y + lambda p * A) + (f - (f + s + x + lambda p * B))) by ring.
        now apply add_nonneg.
      - repeat (apply add_nonneg; try assumption). }
    assert (A0 : A = 0).
    { apply add_zero in sum0; [| exact sm | repeat (apply add_nonneg; try assumption)].
      destruct (mul_zero _ _ sum0) as [l | a]; [| exact a].
      now destruct (pos_nonzero _ positive). }
    assert (B0 : B = 0).
    { rewrite A0 in sum0. replace (lambda p * 0 + (lambda p * B + (x + y))) with
        (lambda p * B + (x + y)) in sum0 by ring.
      apply add_zero in sum0; [| exact st | now apply add_nonneg].
      destruct (mul_zero _ _ sum0) as [l | b]; [| exact b].
      now destruct (pos_nonzero _ positive). }
    intros j hj.
    rewrite (no_spread p c t wf B0 j hj). symmetry.
    exact (no_spread p c m wf A0 j hj).
  Qed.
End Kkt.
