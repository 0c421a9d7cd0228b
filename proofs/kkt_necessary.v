(** The KKT conditions are necessary: a solver that stops elsewhere has not found the optimum. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem kkt.

Section Necessary.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m : nat -> K).

  (** One mass moved by s: the objective is a parabola in s. *)
  Definition moved (m : nat -> K) (j : nat) (s : K) (i : nat) : K :=
    if i =? j then m i + s else m i.

  Lemma moved_difference m j s i : moved m j s i - m i = (if j =? i then 1 else 0) * s.
  Proof. unfold moved. rewrite Nat.eqb_sym. destruct (j =? i); ring. Qed.

  Lemma objective_moved p m j s :
    (j < shapes p)%nat ->
    objective p (moved m j s) =
    objective p m + gradient p m j * s +
    (curvature p (fun k => U p k j) + lambda p / V p j) * (s * s).
  Proof.
    intro hj. rewrite (objective_expands p m).
    rewrite (sum_ext (shapes p) (fun i => gradient p m i * (moved m j s i - m i))
      (fun i => (if j =? i then 1 else 0) * (gradient p m i * s))).
    2: { intros i _. rewrite moved_difference. ring. }
    rewrite (sum_indicator (shapes p) j (fun i => gradient p m i * s)) by exact hj.
    rewrite (sum_ext (shapes p) (fun i => (moved m j s i - m i) * (moved m j s i - m i) / V p i)
      (fun i => (if j =? i then 1 else 0) * (s * s / V p i))).
    2: { intros i _. rewrite !moved_difference, !div_mul. destruct (j =? i); ring. }
    rewrite (sum_indicator (shapes p) j (fun i => s * s / V p i)) by exact hj.
    assert (bend : curvature p (fun k => Phi p (moved m j s) k - Phi p m k) =
                   s * s * curvature p (fun k => U p k j)).
    { unfold curvature. rewrite <- sum_scale. apply sum_ext. intros i _. cbv zeta.
      assert (row : sum (parameters p) (fun k => Y p i k * (Phi p (moved m j s) k - Phi p m k)) =
                    s * sum (parameters p) (fun k => Y p i k * U p k j)).
      { rewrite <- sum_scale. apply sum_ext. intros k _.
        assert (column : Phi p (moved m j s) k - Phi p m k = U p k j * s).
        { unfold Phi. rewrite <- sum_sub.
          rewrite (sum_ext _ _ (fun l => (if j =? l then 1 else 0) * (U p k l * s))).
          - now rewrite (sum_indicator (shapes p) j (fun l => U p k l * s)).
          - intros l _. transitivity (U p k l * (moved m j s l - m l)); [ring |].
            rewrite moved_difference. ring. }
        rewrite column. ring. }
      rewrite row. ring. }
    rewrite bend, !div_mul. ring.
  Qed.

  (** A parabola z s + c s^2 that is not negative for s between 0 and e has z s >= 0 there. *)
  Lemma parabola (z c e : K) :
    0 <= c -> 0 < e -> (forall s, 0 <= s -> s <= e -> 0 <= z * s + c * (s * s)) -> 0 <= z.
  Proof.
    intros hc he h. destruct (le_total 0 z) as [yes | below]; [exact yes |].
    destruct (eq_decided z 0) as [-> | no]; [apply le_refl |].
    (* At s = e w / (w + c e) with w = -z the parabola is -s w^2 / (w + c e), which is negative. *)
    set (w := - z). assert (hw : 0 < w).
    { split; [now apply opp_nonneg |]. intro e0. apply no. replace z with (- w) by (unfold w; ring).
      rewrite <- e0. ring. }
    assert (hd : 0 < w + c * e).
    { apply add_pos; [exact hw |]. apply mul_nonneg; [exact hc | now apply lt_le]. }
    pose proof (pos_nonzero _ hd) as nd.
    set (s := e * w / (w + c * e)).
    assert (s_pos : 0 <= s).
    { apply div_nonneg; [| exact hd]. apply mul_nonneg; now apply lt_le. }
    assert (s_small : s <= e).
    { apply le_of_sub. replace (e - s)
        with (c * (e * e) / (w + c * e)) by (unfold s; field; exact nd).
      apply div_nonneg; [| exact hd]. apply mul_nonneg; [exact hc | apply square_nonneg]. }
    specialize (h s s_pos s_small).
    replace (z * s + c * (s * s)) with (- (e * w * (w * w) / ((w + c * e) * (w + c * e)))) in h.
    2: { unfold s. replace z with (- w) by (unfold w; ring). field. exact nd. }
    assert (positive : 0 < e * w * (w * w) / ((w + c * e) * (w + c * e))).
    { rewrite div_mul. apply mul_pos; [repeat apply mul_pos; assumption |].
      split; [apply inv_nonneg; now apply mul_pos |]. intro e0. symmetry in e0. revert e0.
      apply inv_nonzero. now apply mul_nonzero. }
    destruct positive as [p1 p2]. destruct p2. apply le_antisym; [exact p1 |].
    apply le_of_sub. match type of h with 0 <= ?a => match goal with |- 0 <= ?b =>
      replace b with a by ring end end. exact h.
  Qed.

  (** Claim C3. The KKT conditions are necessary: masses that break them are not the optimum. *)
  Theorem kkt_is_necessary p m : well_formed p -> optimal p m -> kkt p m.
  Proof.
    intros wf [hm best]. split; [exact hm |]. intros j hj.
    set (c := curvature p (fun k => U p k j) + lambda p / V p j).
    assert (hc : 0 <= c).
    { apply add_nonneg; [now apply curvature_nonneg |]. apply div_nonneg; now apply wf. }
    assert (allowed : forall s, 0 <= m j + s -> 0 <= gradient p m j * s + c * (s * s)).
    { intros s hs.
      assert (ok : nonnegative p (moved m j s)).
      { intros i hi. unfold moved. destruct (Nat.eqb_spec i j) as [-> | _];
          [exact hs | now apply hm]. }
      specialize (best _ ok). rewrite (objective_moved p m j s hj) in best. fold c in best.
      apply sub_nonneg in best. match type of best with 0 <= ?a => match goal with |- 0 <= ?b =>
        replace b with a by ring end end. exact best. }
    assert (up : 0 <= gradient p m j).
    { apply (parabola _ c 1 hc one_pos). intros s hs _. apply allowed.
      apply add_nonneg; [now apply hm | exact hs]. }
    split; [exact up |].
    destruct (eq_decided (m j) 0) as [-> | some]; [ring |].
    assert (down : 0 <= - gradient p m j).
    { apply (parabola _ c (m j) hc).
      - split; [now apply hm | auto].
      - intros s hs hsm. replace (- gradient p m j * s + c * (s * s)) with
          (gradient p m j * (- s) + c * (- s * - s)) by ring.
        apply allowed. apply sub_nonneg in hsm. replace (m j + - s) with (m j - s) by ring.
        exact hsm. }
    assert (zero : gradient p m j = 0).
    { apply le_antisym; [| exact up]. apply le_of_sub.
      replace (0 - gradient p m j) with (- gradient p m j) by ring. exact down. }
    rewrite zero. ring.
  Qed.
End Necessary.
