(** What the certificate checker computes (certificate/bound.cpp): weak duality from any residual
    whatever, with other columns beside the masses; the joint minimum over the masses by water
    filling; and a mass bound proved from the rows. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem kkt.

Section Duality.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (t m : nat -> K).

  (** Other columns of the rows, such as friction: C x, n of them. *)
  Record Others := { others : nat; C : nat -> nat -> K }.

  Definition others_at (o : Others) (x : nat -> K) (i : nat) : K :=
    sum (others o) (fun k => C o i k * x k).

  (** r = Y Phi + C x - F *)
  Definition full_residual p o t x (i : nat) : K := residual p (Phi p t) i + others_at o x i.

  (** r^T W r + lambda sum_j t_j^2 / V_j *)
  Definition full_objective p o t x : K :=
    sum (rows p) (fun i => W p i * (full_residual p o t x i * full_residual p o t x i)) +
        density p t.

  (** Half the slopes of the data term where the residual is r. *)
  Definition mass_slope p (r : nat -> K) (j : nat) : K :=
    sum (parameters p) (fun k => U p k j * sum (rows p) (fun i => Y p i k * (W p i * r i))).
  Definition other_slope p o (r : nat -> K) (k : nat) : K :=
    sum (rows p) (fun i => C o i k * (W p i * r i)).

  (** What the masses and the other unknowns contribute to the bound. *)
  Definition mass_terms p (a : nat -> K) t : K :=
    sum (shapes p) (fun j => 2 * a j * t j) + density p t.
  Definition other_terms o (c x : nat -> K) : K := sum (others o) (fun k => 2 * c k * x k).

  Definition constant_terms p (r : nat -> K) : K :=
    sum (rows p) (fun i => - (W p i * r i * (r i + 2 * F p i))).

  Lemma slopes_of_masses p r t :
    sum (rows p) (fun i => W p i * r i * sum (parameters p) (fun k => Y p i k * Phi p t k)) =
    sum (shapes p) (fun j => mass_slope p r j * t j).
  Proof.
    rewrite (sum_ext (rows p) _ (fun i => sum (parameters p) (fun k =>
      Phi p t k * (Y p i k * (W p i * r i))))).
    2: { intros i _. rewrite <- sum_scale. apply sum_ext. intros. ring. }
    rewrite sum_swap.
    rewrite (sum_ext (parameters p) _ (fun k => sum (shapes p) (fun j =>
      t j * (U p k j * sum (rows p) (fun i => Y p i k * (W p i * r i)))))).
    2: { intros k _. rewrite sum_scale. unfold Phi.
         transitivity (sum (rows p) (fun i => Y p i k * (W p i * r i)) *
                       sum (shapes p) (fun j => U p k j * t j)); [ring |].
         rewrite <- sum_scale. apply sum_ext. intros. ring. }
    rewrite sum_swap. apply sum_ext. intros j _. rewrite sum_scale. unfold mass_slope. ring.
  Qed.

  Lemma slopes_of_others p o r x :
    sum (rows p) (fun i => W p i * r i * others_at o x i) =
    sum (others o) (fun k => other_slope p o r k * x k).
  Proof.
    rewrite (sum_ext (rows p) _ (fun i => sum (others o) (fun k =>
      x k * (C o i k * (W p i * r i))))).
    2: { intros i _. unfold others_at. rewrite <- sum_scale. apply sum_ext. intros. ring. }
    rewrite sum_swap. apply sum_ext. intros k _. rewrite sum_scale. unfold other_slope. ring.
  Qed.

  (** The objective is the dual's terms and || W^(1/2) (its residual - r) ||^2. *)
  Lemma objective_from_any_residual p o r t x :
    full_objective p o t x =
    constant_terms p r + mass_terms p (mass_slope p r) t + other_terms o (other_slope p o r) x +
    sum (rows p) (fun i =>
      W p i * ((full_residual p o t x i - r i) * (full_residual p o t x i - r i))).
  Proof.
    unfold mass_terms, other_terms, full_objective.
    rewrite (sum_ext (shapes p) _ (fun j => 2 * (mass_slope p r j * t j))) by (intros; ring).
    rewrite (sum_ext (others o) _ (fun k => 2 * (other_slope p o r k * x k))) by (intros; ring).
    rewrite !sum_scale, <- slopes_of_masses, <- slopes_of_others, <- !sum_scale.
    assert (rows_only :
      sum (rows p) (fun i => W p i * (full_residual p o t x i * full_residual p o t x i)) =
      constant_terms p r +
      sum (rows p) (fun i =>
        2 * (W p i * r i * sum (parameters p) (fun k => Y p i k * Phi p t k))) +
      sum (rows p) (fun i => 2 * (W p i * r i * others_at o x i)) +
      sum (rows p) (fun i =>
        W p i * ((full_residual p o t x i - r i) * (full_residual p o t x i - r i)))).
    { unfold constant_terms. rewrite <- !sum_add. apply sum_ext. intros i _.
      unfold full_residual, residual. ring. }
    rewrite rows_only. ring.
  Qed.

  (** Claim C14. From any r, with whatever bounds the terms of masses and other unknowns from
      below: no feasible point has a lower objective. *)
  Theorem weak_duality p o r masses rest :
    well_formed p ->
    forall t x, masses <= mass_terms p (mass_slope p r) t ->
    rest <= other_terms o (other_slope p o r) x ->
    constant_terms p r + masses + rest <= full_objective p o t x.
  Proof.
    intros [w _] t x hm hr. rewrite (objective_from_any_residual p o r t x).
    match goal with |- ?a <= ?b => replace a with (a + 0) by ring end.
    apply le_add; [apply le_add; [apply le_add; [apply le_refl | exact hm] | exact hr] |].
    apply sum_nonneg. intros i hi. apply mul_nonneg; [now apply lt_le, w | apply square_nonneg].
  Qed.

  (** Claim C14. Of another unknown the end of its range that its slope points away from is the
      least. *)
  Theorem ends_of_ranges o (c x e : nat -> K) :
    (forall k, (k < others o)%nat -> (0 <= c k /\ e k <= x k) \/ (c k <= 0 /\ x k <= e k)) ->
    other_terms o c e <= other_terms o c x.
  Proof.
    intro h. apply sum_le. intros k hk.
    apply le_of_sub. replace (2 * c k * x k - 2 * c k * e k) with (2 * (c k * (x k - e k))) by ring.
    apply mul_nonneg; [apply lt_le, two_pos |].
    destruct (h k hk) as [[hc he] | [hc he]].
    - apply mul_nonneg; [exact hc | now apply sub_nonneg].
    - replace (c k * (x k - e k)) with (- c k * (e k - x k)) by ring.
      apply mul_nonneg; [now apply opp_nonneg | now apply sub_nonneg].
  Qed.

  (** Sum over the shapes under water: those whose slope is below -nu. *)
  Definition over (n : nat) (under : nat -> bool) (f : nat -> K) : K :=
    sum n (fun j => if under j then f j else 0).

  (** Claim C14. Water filling: where nu >= 0 is zero or the masses under water fill M, the terms of
      the masses are at least -(sum of V_j (a_j^2 - nu^2)) / lambda over the shapes under water. *)
  Theorem water_filling p (a : nat -> K) (nu M : K) (under : nat -> bool) t :
    well_formed p -> 0 < lambda p -> 0 <= nu ->
    (forall j, (j < shapes p)%nat -> if under j then a j + nu <= 0 else 0 <= a j + nu) ->
    nu * (over (shapes p) under (fun j => - (V p j * (a j + nu))) - lambda p * M) = 0 ->
    nonnegative p t -> nu = 0 \/ sum (shapes p) t <= M ->
    - over (shapes p) under (fun j => V p j * (a j * a j - nu * nu)) / lambda p <= mass_terms p a t.
  Proof.
    intros wf l hnu water full ht total.
    pose proof (pos_nonzero _ l) as nl.
    set (floor := fun j => if under j then - (V p j * ((a j + nu) * (a j + nu))) / lambda p else 0).
    assert (each : sum (shapes p) floor <=
                   sum (shapes p) (fun j => 2 * (a j + nu) * t j + lambda p * (t j * t j / V p j))).
    { apply sum_le. intros j hj. unfold floor. specialize (water j hj).
      assert (v : 0 < V p j) by now apply wf. pose proof (pos_nonzero _ v) as nv.
      destruct (under j).
      - apply le_of_sub.
        match goal with |- 0 <= ?d => replace d with
          (lambda p * ((t j + (a j + nu) * V p j / lambda p) *
                       (t j + (a j + nu) * V p j / lambda p) / V p j)) by (field; auto) end.
        apply mul_nonneg; [now apply lt_le |]. apply div_nonneg; [apply square_nonneg | exact v].
      - apply add_nonneg.
        + apply mul_nonneg; [| now apply ht].
          apply mul_nonneg; [apply lt_le, two_pos | exact water].
        + apply mul_nonneg; [now apply lt_le |].
          apply div_nonneg; [apply square_nonneg | exact v]. }
    assert (left_side :
      - over (shapes p) under (fun j => V p j * (a j * a j - nu * nu)) / lambda p =
                        sum (shapes p) floor - 2 * (nu * M)).
    { assert (filled : nu * M = over (shapes p) under
                (fun j => - (nu * (V p j * (a j + nu)))) / lambda p).
      { transitivity ((nu * over (shapes p) under (fun j => - (V p j * (a j + nu))) -
          nu * (over (shapes p) under (fun j => - (V p j * (a j + nu))) - lambda p * M)) /
          lambda p).
        - field. exact nl.
        - rewrite full, !div_mul. unfold over. rewrite <- sum_scale.
          rewrite (sum_ext (shapes p) _
            (fun j => if under j then - (nu * (V p j * (a j + nu))) else 0)).
          + ring.
          + intros j _. destruct (under j); ring. }
      rewrite filled, !div_mul. unfold over, floor.
      transitivity (sum (shapes p) (fun j => - inv (lambda p) *
        (if under j then V p j * (a j * a j - nu * nu) else 0))).
      { rewrite sum_scale. ring. }
      transitivity (sum (shapes p) (fun j =>
        (if under j then - (V p j * ((a j + nu) * (a j + nu))) / lambda p else 0) -
        2 * inv (lambda p) * (if under j then - (nu * (V p j * (a j + nu))) else 0))).
      { apply sum_ext. intros j _. rewrite div_mul. destruct (under j); ring. }
      rewrite sum_sub, sum_scale. ring. }
    rewrite left_side.
    assert (right_side : mass_terms p a t =
      sum (shapes p) (fun j => 2 * (a j + nu) * t j + lambda p * (t j * t j / V p j)) -
      2 * (nu * sum (shapes p) t)).
    { unfold mass_terms, density. rewrite <- !sum_scale, <- sum_add, <- sum_sub.
      apply sum_ext. intros. ring. }
    rewrite right_side. apply le_of_sub. apply sub_nonneg in each.
    match goal with |- 0 <= ?b - ?y - (?x - ?z) =>
      replace (b - y - (x - z)) with ((b - x) + (z - y)) by ring end.
    apply add_nonneg; [exact each |].
    replace (2 * (nu * M) - 2 * (nu * sum (shapes p) t))
        with (2 * (nu * (M - sum (shapes p) t))) by ring.
    destruct total as [-> | total].
    - match goal with |- 0 <= ?d => replace d with (0 : K) by ring end. apply le_refl.
    - apply mul_nonneg; [apply lt_le, two_pos |].
      apply mul_nonneg; [exact hnu | now apply sub_nonneg].
  Qed.

  (** Claim C14. Of all masses that weigh no more than M the terms are least with all of it on the
      steepest shape, or none: also without a density term. *)
  Theorem steepest_shape p (a t : nat -> K) M low :
    well_formed p -> low <= 0 -> (forall j, (j < shapes p)%nat -> low <= a j) ->
    nonnegative p t -> sum (shapes p) t <= M -> 2 * (M * low) <= mass_terms p a t.
  Proof.
    intros wf hlow slopes ht total.
    unfold mass_terms. replace (2 * (M * low)) with (2 * (M * low) + 0) by ring. apply le_add.
    - rewrite (sum_ext (shapes p) _ (fun j => 2 * (a j * t j))) by (intros; ring).
      rewrite sum_scale. apply le_scale; [apply lt_le, two_pos |].
      apply (le_trans _ (low * sum (shapes p) t)).
      + apply le_of_sub.
        replace (low * sum (shapes p) t - M * low) with ((M - sum (shapes p) t) * - low) by ring.
        apply mul_nonneg; [now apply sub_nonneg | now apply opp_nonneg].
      + rewrite <- sum_scale. apply sum_le. intros j hj.
        replace (low * t j) with (t j * low) by ring.
        replace (a j * t j) with (t j * a j) by ring.
        apply le_scale; [now apply ht | now apply slopes].
    - unfold density. apply mul_nonneg; [apply wf |]. apply sum_nonneg. intros j hj.
      apply div_nonneg; [apply square_nonneg | now apply wf].
  Qed.

  (** Claim C14. At the residual of a KKT point nothing is given away: the terms are least at its
      masses, and the bound is its objective. *)
  Theorem duality_is_tight p m :
    well_formed p -> kkt p m ->
    let r := residual p (Phi p m) in
    constant_terms p r + mass_terms p (mass_slope p r) m = objective p m /\
    forall t, nonnegative p t -> mass_terms p (mass_slope p r) m <= mass_terms p (mass_slope p r) t.
  Proof.
    intros wf h r. pose (none := {| others := 0; C := fun _ _ => 0 |}).
    assert (whole : forall t, full_objective p none t (fun _ => 0) = objective p t).
    { intro t. unfold full_objective, objective, data, data_of. f_equal. apply sum_ext. intros i _.
      unfold full_residual, others_at. cbn. ring. }
    split.
    - rewrite <- whole, (objective_from_any_residual p none r m).
      unfold other_terms. cbn [others none sum].
      rewrite (sum_ext (rows p) _ (fun _ => 0)); [rewrite sum_zero; ring |].
      intros i _. unfold full_residual, others_at. cbn. unfold r. ring.
    - intros t ht.
      assert (slopes : forall j,
        gradient p m j = 2 * mass_slope p r j + 2 * lambda p * m j / V p j).
      { intro j. unfold gradient. f_equal. unfold mass_slope, slope. rewrite <- sum_scale.
        apply sum_ext. intros. fold r. ring. }
      apply le_of_sub.
      assert (e : mass_terms p (mass_slope p r) t - mass_terms p (mass_slope p r) m =
        sum (shapes p) (fun j => gradient p m j * (t j - m j)) +
        lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j)).
      { unfold mass_terms, density. rewrite <- !sum_scale, <- !sum_add, <- sum_sub.
        apply sum_ext. intros j _. rewrite slopes, !div_mul. ring. }
      rewrite e. apply add_nonneg; [now apply kkt_slope |].
      apply mul_nonneg; [apply wf | now apply spread_nonneg].
  Qed.

  Lemma cauchy_schwarz n (w d r : nat -> K) :
    (forall i, (i < n)%nat -> 0 < w i) ->
    dot n d r * dot n d r <= sum n (fun i => d i * d i / w i) * sum n (fun i => w i * (r i * r i)).
  Proof.
    intro hw. set (A := sum n (fun i => d i * d i / w i)). set (B := dot n d r).
    set (E := sum n (fun i => w i * (r i * r i))).
    assert (terms : forall i, (i < n)%nat -> 0 <= d i * d i / w i).
    { intros i hi. apply div_nonneg; [apply square_nonneg | now apply hw]. }
    assert (squares : A * (A * E - B * B) =
                      sum n (fun i =>
                        w i * ((A * r i - B * (d i / w i)) * (A * r i - B * (d i / w i))))).
    { transitivity ((A * A) * sum n (fun i => w i * (r i * r i)) -
                    (2 * A * B) * sum n (fun i => d i * r i) +
                    (B * B) * sum n (fun i => d i * d i / w i)); [unfold A, B, E, dot; ring |].
      rewrite <- !sum_scale, <- sum_sub, <- sum_add.
      apply sum_ext. intros i hi. field. now apply pos_nonzero, hw. }
    assert (positive : 0 <= A * (A * E - B * B)).
    { rewrite squares. apply sum_nonneg. intros i hi.
      apply mul_nonneg; [now apply lt_le, hw | apply square_nonneg]. }
    destruct (eq_decided A 0) as [zero | no].
    - assert (B0 : B = 0).
      { unfold B, dot. rewrite (sum_ext n _ (fun _ => 0)); [apply sum_zero |]. intros i hi.
        pose proof (sum_nonneg_zero n _ terms zero i hi) as di. cbv beta in di.
        rewrite div_mul in di. destruct (mul_zero _ _ di) as [e | e].
        - rewrite (square_zero _ e). ring.
        - destruct (inv_nonzero (w i)); [now apply pos_nonzero, hw | exact e]. }
      rewrite B0, zero. replace ((0 : K) * 0) with (0 * E) by ring. apply le_refl.
    - apply le_of_sub.
      replace (A * E - B * B) with (inv A * (A * (A * E - B * B))) by (field; exact no).
      apply mul_nonneg; [| exact positive]. apply inv_nonneg. split; [now apply sum_nonneg |]. auto.
  Qed.

  Lemma below_root (x root : K) : 0 <= root -> x * x <= root * root -> x <= root.
  Proof.
    intros hr h. destruct (le_total x root) as [e | above]; [exact e |].
    apply sub_nonneg in h. pose proof (sub_nonneg _ _ above) as ha.
    assert (sum_nn : 0 <= x + root) by (apply add_nonneg; [now apply (le_trans _ root) | exact hr]).
    assert (none : (x - root) * (x + root) = 0).
    { apply le_antisym.
      - apply le_of_sub. match goal with |- 0 <= ?d => replace d with (root * root - x * x)
          by ring end.
        exact h.
      - now apply mul_nonneg. }
    destruct (mul_zero _ _ none) as [e | e].
    - replace x with (x - root + root) by ring. rewrite e. replace (0 + root) with root by ring.
      apply le_refl.
    - apply le_of_sub. replace (root - x) with (2 * root - (x + root)) by ring. rewrite e.
      replace (2 * root - 0) with (2 * root) by ring.
      apply mul_nonneg; [apply lt_le, two_pos | exact hr].
  Qed.

  (** Claim C14. The mass bound that the checker proves: if a combination [d] of the rows weighs
      every shape by at least [share] of its mass, what leaves an objective of at most [upper] is
      no heavier than this. *)
  Theorem rows_bound_the_mass p (d : nat -> K) share upper root t :
    well_formed p -> nonnegative p t -> objective p t <= upper -> 0 <= root ->
    upper * sum (rows p) (fun i => d i * d i / W p i) <= root * root ->
    (forall j, (j < shapes p)%nat ->
       share <= sum (parameters p) (fun k => U p k j * sum (rows p) (fun i => Y p i k * d i))) ->
    share * sum (shapes p) t <= dot (rows p) d (F p) + root.
  Proof.
    intros wf ht hup hroot hr hshare.
    set (r := residual p (Phi p t)).
    assert (size : dot (rows p) d r <= root).
    { apply below_root; [exact hroot |].
      eapply le_trans; [apply (cauchy_schwarz (rows p) (W p)); apply wf |].
      eapply le_trans; [| exact hr].
      match goal with |- ?a * ?b <= _ => replace (a * b) with (b * a) by ring end.
      match goal with |- ?b * ?a <= ?u * _ =>
        replace (b * a) with (a * b) by ring; replace (u * a) with (a * u) by ring end.
      apply le_scale.
      - apply sum_nonneg. intros i hi. apply div_nonneg; [apply square_nonneg | now apply wf].
      - apply (le_trans _ (objective p t)); [| exact hup].
        unfold objective. apply le_of_sub. fold r. unfold data, data_of.
        match goal with |- 0 <= ?a + ?b - ?c => replace (a + b - c) with b by (fold r; ring) end.
        unfold density. apply mul_nonneg; [apply wf |]. apply sum_nonneg. intros j hj.
        apply div_nonneg; [apply square_nonneg | now apply wf]. }
    assert (weighed : sum (shapes p) (fun j => sum (parameters p) (fun k =>
        U p k j * sum (rows p) (fun i => Y p i k * d i)) * t j) =
      dot (rows p) d (F p) + dot (rows p) d r).
    { pose (q := {| rows := rows p; parameters := parameters p; shapes := shapes p; Y := Y p;
        F := F p;
                    W := fun _ => 1; U := U p; V := V p; lambda := lambda p |}).
      pose proof (slopes_of_masses q d t) as s. unfold mass_slope, Phi in s. cbn in s.
      transitivity (sum (shapes p) (fun j => sum (parameters p) (fun k =>
        U p k j * sum (rows p) (fun i => Y p i k * (1 * d i))) * t j)).
      { apply sum_ext. intros j _. f_equal. apply sum_ext. intros k _. f_equal.
        apply sum_ext. intros. ring. }
      rewrite <- s. unfold dot, r, residual, Phi. rewrite <- sum_add. apply sum_ext. intros. ring. }
    apply (le_trans _ (dot (rows p) d (F p) + dot (rows p) d r)).
    - rewrite <- weighed, <- sum_scale. apply sum_le. intros j hj.
      replace (share * t j) with (t j * share) by ring.
      match goal with |- _ <= ?b * t j => replace (b * t j) with (t j * b) by ring end.
      apply le_scale; [now apply ht | now apply hshare].
    - apply le_add; [apply le_refl | exact size].
  Qed.
End Duality.
