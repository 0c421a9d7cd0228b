(** The floor under all bodies that can exist, wherever they have mass (certificate/floor.cpp,
    floor_of_bodies): weak duality over the cone of positive semidefinite pseudo-inertias. With
    relaxations.v it puts the optima of one data set in order by numbers. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums space mass_problem consistency relaxations body floor
  duality residual_floor.

Section Forms.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (A B : nat -> nat -> K) (v : nat -> K) (t : K).

  Definition symmetric A : Prop := forall i j, A i j = A j i.

  (** v^T A v *)
  Definition form n A v : K := sum n (fun i => sum n (fun j => A i j * v i * v j)).
  Definition semidefinite n A : Prop := forall v, 0 <= form n A v.

  (** trace (A^T B) *)
  Definition pairing n A B : K := sum n (fun i => sum n (fun j => A i j * B i j)).

  (** v with t appended. *)
  Definition appended n v t (i : nat) : K := if i =? n then t else v i.

  Lemma sum_appended n v t (f : nat -> K -> K) :
    sum n (fun i => f i (appended n v t i)) = sum n (fun i => f i (v i)).
  Proof.
    apply sum_ext. intros i hi. unfold appended. now rewrite (proj2 (Nat.eqb_neq i n)) by lia.
  Qed.

  Lemma form_grows n A v t :
    symmetric A ->
    form (S n) A (appended n v t) =
    form n A v + 2 * t * sum n (fun j => A n j * v j) + A n n * t * t.
  Proof.
    intro sym. unfold form. cbn [sum].
    assert (last : appended n v t n = t) by (unfold appended; now rewrite Nat.eqb_refl).
    rewrite last, sum_add.
    rewrite (sum_appended n v t (fun j x => A n j * t * x)).
    rewrite (sum_appended n v t (fun i x => A i n * x * t)).
    rewrite (sum_appended n v t (fun i x =>
      sum n (fun j => A i j * x * appended n v t j))).
    rewrite (sum_ext n (fun i => sum n (fun j => A i j * v i * appended n v t j))
                       (fun i => sum n (fun j => A i j * v i * v j))).
    2: { intros i _. apply (sum_appended n v t (fun j x => A i j * v i * x)). }
    rewrite (sum_ext n (fun i => A i n * v i * t) (fun j => t * (A n j * v j)))
      by (intros j _; rewrite (sym j n); ring).
    rewrite (sum_ext n (fun j => A n j * t * v j) (fun j => t * (A n j * v j)))
      by (intros; ring).
    rewrite sum_scale. ring.
  Qed.

  Lemma pairing_grows n A B :
    symmetric A -> symmetric B ->
    pairing (S n) A B =
    pairing n A B + 2 * sum n (fun j => A n j * B n j) + A n n * B n n.
  Proof.
    intros sa sb. unfold pairing. cbn [sum]. rewrite sum_add.
    rewrite (sum_ext n (fun i => A i n * B i n) (fun j => A n j * B n j))
      by (intros j _; now rewrite (sa j n), (sb j n)).
    ring.
  Qed.

  Lemma semidefinite_below n A : symmetric A -> semidefinite (S n) A -> semidefinite n A.
  Proof.
    intros sym h v. specialize (h (appended n v 0)). rewrite form_grows in h by exact sym.
    match type of h with 0 <= ?a + ?b + ?c => replace (a + b + c) with a in h by ring end. exact h.
  Qed.

  Lemma last_nonneg n A : symmetric A -> semidefinite (S n) A -> 0 <= A n n.
  Proof.
    intros sym h. specialize (h (appended n (fun _ => 0) 1)). rewrite form_grows in h by exact sym.
    unfold form in h.
    rewrite (sum_ext n _ (fun _ => 0)) in h.
    2: { intros i _. rewrite (sum_ext n _ (fun _ => 0)) by (intros; ring). apply sum_zero. }
    rewrite (sum_ext n (fun j => A n j * 0) (fun _ => 0)) in h by (intros; ring).
    rewrite !sum_zero in h. match type of h with 0 <= ?a => replace a with (A n n) in h by ring end.
    exact h.
  Qed.

  Lemma product_of_sums n (f g : nat -> K) :
    sum n (fun i => sum n (fun j => f i * g j)) = sum n f * sum n g.
  Proof.
    rewrite (sum_ext n _ (fun i => sum n g * f i)).
    - rewrite sum_scale. ring.
    - intros i _. rewrite sum_scale. ring.
  Qed.

  (** A constant and a slope that are never negative together: there is no slope. *)
  Lemma no_slope (c s : K) : (forall t, 0 <= c + t * s) -> s = 0.
  Proof.
    intro h. destruct (eq_decided s 0) as [| no]; [assumption | exfalso].
    specialize (h (- (c + 1) / s)).
    replace (c + - (c + 1) / s * s) with (- (1 : K)) in h by (field; exact no).
    apply (one_neq_zero (K := K)). apply le_antisym.
    - apply le_of_sub. replace (0 - 1 : K) with (- (1 : K)) by ring. exact h.
    - apply one_nonneg.
  Qed.

  (** Claim C18. Two positive semidefinite matrices have a product whose trace is not negative. *)
  Theorem semidefinite_pairing n A B :
    symmetric A -> symmetric B -> semidefinite n A -> semidefinite n B -> 0 <= pairing n A B.
  Proof.
    revert A. induction n as [| n IH]; intros A sa sb ha hb; [apply le_refl |].
    pose proof (semidefinite_below n B sb hb) as below.
    rewrite pairing_grows by assumption.
    destruct (eq_decided (A n n) 0) as [zero | nonzero].
    - (* Then the rest of the row is zero in every direction, that of B among them. *)
      assert (row : sum n (fun j => A n j * B n j) = 0).
      { apply (no_slope (form n A (B n))). intro t.
        specialize (ha (appended n (B n) (t / 2))). rewrite form_grows in ha by exact sa.
        rewrite zero in ha.
        match type of ha with 0 <= ?a + _ + _ => match goal with |- 0 <= ?b =>
          replace b with (a + 2 * (t / 2) * sum n (fun j => A n j * B n j) + 0 * (t / 2) * (t / 2))
        end end; [exact ha |].
        field. apply pos_nonzero, two_pos. }
      rewrite row, zero.
      match goal with |- 0 <= ?a => replace a with (pairing n A B) by ring end.
      apply IH; [exact sa | exact sb | now apply semidefinite_below | exact below].
    - (* Elimination of the last row leaves a semidefinite matrix. *)
      set (a := A n n) in *.
      assert (pos : 0 < a).
      { split; [now apply last_nonneg | congruence]. }
      pose (rest := fun i j => A i j - inv a * (A n i * A n j)).
      assert (sr : symmetric rest) by (intros i j; unfold rest; rewrite (sa i j); ring).
      assert (hr : semidefinite n rest).
      { intro v. pose (s := sum n (fun j => A n j * v j)).
        specialize (ha (appended n v (- inv a * s))). rewrite form_grows in ha by exact sa.
        fold a in ha. fold s in ha. unfold form, rest.
        rewrite (sum_ext n _ (fun i => sum n (fun j => A i j * v i * v j) -
          inv a * sum n (fun j => A n i * v i * (A n j * v j)))).
        2: { intros i _. rewrite <- sum_scale, <- sum_sub. apply sum_ext. intros. ring. }
        rewrite sum_sub, sum_scale, product_of_sums. fold s. fold (form n A v).
        match type of ha with 0 <= ?x => match goal with |- 0 <= ?y =>
          replace y with x; [exact ha |] end end.
        field. now apply pos_nonzero. }
      pose proof (IH rest sr sb hr below) as tail.
      pose proof (hb (appended n (A n) a)) as row. rewrite form_grows in row by exact sb.
      assert (split : pairing n A B =
                      pairing n rest B + inv a * form n B (A n)).
      { unfold pairing, rest, form. rewrite <- sum_scale, <- sum_add. apply sum_ext. intros i _.
        rewrite <- sum_scale, <- sum_add. apply sum_ext. intros. ring. }
      rewrite (sum_ext n (fun j => B n j * A n j) (fun j => A n j * B n j)) in row
        by (intros; ring).
      rewrite split.
      match goal with |- 0 <= pairing n rest B + ?x + ?y + ?z =>
        replace (pairing n rest B + x + y + z) with
          (pairing n rest B + inv a * (form n B (A n) + y * a + B n n * a * a)) end.
      + apply add_nonneg; [exact tail |]. apply mul_nonneg; [now apply inv_nonneg |].
        match type of row with 0 <= ?x => match goal with |- 0 <= ?y =>
          replace y with x; [exact row |] end end. ring.
      + field. now apply pos_nonzero.
  Qed.
End Forms.

Section BodiesFloor.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (g Phi : Ten K) (w y : Vec3 K).

  (** [[S, h], [h^T, m]] *)
  Definition bordered (S : Mat3 K) (h : Vec3 K) (m : K) (i j : nat) : K :=
    let axis k := match k with 0 => ax | 1 => ay | _ => az end%nat in
    if (i <? 3)%nat then if (j <? 3)%nat then S (axis i) (axis j) else h (axis i)
    else if (j <? 3)%nat then h (axis j) else m.

  Lemma bordered_symmetric S h m :
    (forall i j, S i j = S j i) -> symmetric (bordered S h m).
  Proof.
    intros sym i j. unfold bordered. destruct (i <? 3)%nat, (j <? 3)%nat; try reflexivity.
    apply sym.
  Qed.

  Definition pseudo_inertia_matrix Phi : nat -> nat -> K :=
    bordered (second_moments Phi) (first_moment Phi) (mass Phi).

  (** quadric.cpp, cost_of_point, twice: what a unit point mass costs is x^T A x + b^T x + c. *)
  Definition twice_A g : Mat3 K := fun i j =>
    match i, j with
    | ax, ax => 2 * (g 7%nat + g 9%nat) | ay, ay => 2 * (g 4%nat + g 9%nat)
    | az, az => 2 * (g 4%nat + g 7%nat)
    | ax, ay | ay, ax => - g 5%nat | ax, az | az, ax => - g 6%nat | ay, az | az, ay => - g 8%nat
    end.
  Definition b g : Vec3 K := first_moment g.

  Lemma twice_A_symmetric g i j : twice_A g i j = twice_A g j i.
  Proof. destruct i, j; reflexivity. Qed.

  (** Twice the cost, less [low] for each unit of mass, as a form of (x, 1). *)
  Definition cost_matrix g low : nat -> nat -> K := bordered (twice_A g) (b g) (2 * (g 0%nat - low)).

  Lemma cost_at_a_point g y :
    2 * sum 10 (fun k => g k * point_parameters y k) =
    dot3 y (times (twice_A g) y) + 2 * dot3 (b g) y + 2 * g 0%nat.
  Proof.
    unfold point_parameters, from_origin, steiner, identity, twice_A, b, first_moment, dot3, times,
      sum3. cbn. ring.
  Qed.

  Lemma cost_form g low v :
    let w i := v match i with ax => 0 | ay => 1 | az => 2 end%nat in
    form 4 (cost_matrix g low) v =
    dot3 w (times (twice_A g) w) + 2 * v 3%nat * dot3 (b g) w +
    2 * (v 3%nat * v 3%nat) * (g 0%nat - low).
  Proof.
    unfold form, cost_matrix, bordered, dot3, times, sum3, twice_A, b, first_moment. cbn. ring.
  Qed.

  (** A polynomial with a floor has no direction in which it falls faster than linearly. *)
  Lemma no_fall (alpha beta gamma : K) :
    (forall t : K, 0 <= t * t * alpha + t * beta + gamma) -> 0 <= alpha.
  Proof.
    intro h. destruct (le_total 0 alpha) as [| neg]; [assumption |].
    destruct (eq_decided alpha 0) as [-> | nonzero]; [apply le_refl | exfalso].
    assert (even : forall t : K, 0 <= 2 * (t * t * alpha + gamma)).
    { intro t. pose proof (add_nonneg _ _ (h t) (h (- t))) as two.
      match type of two with 0 <= ?x => match goal with |- 0 <= ?y =>
        replace y with x by ring end end. exact two. }
    assert (c : 0 <= gamma).
    { specialize (h 0). match type of h with 0 <= ?x => replace x with gamma in h by ring end.
      exact h. }
    assert (up : 0 <= - alpha) by now apply opp_nonneg.
    assert (pos : 0 < - alpha).
    { split; [exact up |]. intro e. apply nonzero. replace alpha with (- - alpha) by ring.
      rewrite <- e. ring. }
    pose (u := (gamma + 1) / - alpha).
    assert (hu : alpha * u = - (gamma + 1)) by (unfold u; field; now apply pos_nonzero).
    specialize (even (u + 1)).
    assert (value : 2 * ((u + 1) * (u + 1) * alpha + gamma) +
                    2 * (- alpha * (u * u) + gamma + - alpha + 1) = - (2 : K)).
    { replace ((u + 1) * (u + 1) * alpha) with (alpha * (u * u) + 2 * (alpha * u) + alpha) by ring.
      rewrite hu. ring. }
    assert (more : 0 <= 2 * (- alpha * (u * u) + gamma + - alpha + 1)).
    { apply mul_nonneg; [apply lt_le, two_pos |].
      repeat apply add_nonneg; try assumption; try apply one_nonneg.
      apply mul_nonneg; [exact up | apply square_nonneg]. }
    pose proof (add_nonneg _ _ even more) as bad. rewrite value in bad.
    pose proof (two_pos (K := K)) as [two nontwo]. apply nontwo. apply le_antisym; [exact two |].
    apply le_of_sub. replace (0 - 2 : K) with (- (2 : K)) by ring. exact bad.
  Qed.

  (** What costs at least [low] wherever in space it is makes a semidefinite form. *)
  Lemma cost_semidefinite g low :
    (forall y, low <= sum 10 (fun k => g k * point_parameters y k)) ->
    semidefinite 4 (cost_matrix g low).
  Proof.
    intros h v. rewrite cost_form. cbv zeta.
    set (w := fun i => v match i with ax => 0 | ay => 1 | az => 2 end%nat).
    set (s := v 3%nat). clearbody w s.
    set (alpha := dot3 w (times (twice_A g) w)).
    assert (along : forall t : K,
      0 <= t * t * alpha + t * (2 * dot3 (b g) w) + 2 * (g 0%nat - low)).
    { intro t. specialize (h (fun i => t * w i)). apply sub_nonneg in h.
      pose proof (mul_nonneg _ _ (lt_le _ _ two_pos) h) as twice.
      match type of twice with 0 <= ?x => match goal with |- 0 <= ?y =>
        replace y with x; [exact twice |] end end.
      match goal with |- 2 * (?cost - low) = _ =>
        replace (2 * (cost - low)) with (2 * cost - 2 * low) by ring end.
      rewrite cost_at_a_point. unfold alpha, dot3, times, sum3. ring. }
    destruct (eq_decided s 0) as [zero | nonzero].
    - rewrite zero. match goal with |- 0 <= ?x => replace x with alpha by ring end.
      now apply no_fall in along.
    - specialize (along (1 / s)).
      pose proof (mul_nonneg _ _ (square_nonneg s) along) as scaled.
      match type of scaled with 0 <= ?x => match goal with |- 0 <= ?y =>
        replace y with x; [exact scaled |] end end.
      field. exact nonzero.
  Qed.

  Lemma body_semidefinite Phi : consistent Phi -> semidefinite 4 (pseudo_inertia_matrix Phi).
  Proof.
    intros h v. specialize (h (fun i => v match i with ax => 0 | ay => 1 | az => 2 end%nat)
                              (v 3%nat)).
    match type of h with 0 <= ?x => match goal with |- 0 <= ?y =>
      replace y with x; [exact h |] end end.
    unfold form, pseudo_inertia_matrix, bordered, pseudo_inertia, dot3, times, sum3. cbn. ring.
  Qed.

  Lemma cost_of_a_body g low Phi :
    pairing 4 (cost_matrix g low) (pseudo_inertia_matrix Phi) =
    2 * (sum 10 (fun k => g k * Phi k) - low * mass Phi).
  Proof.
    unfold pairing, cost_matrix, pseudo_inertia_matrix, bordered, twice_A, b, second_moments, trace,
      tensor, first_moment, mass, sum3, identity. cbn. field. apply pos_nonzero, two_pos.
  Qed.

  (** Claim C18. A body that can exist costs at least what the cheapest place of all of space does. *)
  Theorem no_body_is_cheaper_than_a_point g low Phi :
    (forall y, low <= sum 10 (fun k => g k * point_parameters y k)) -> consistent Phi ->
    low * mass Phi <= sum 10 (fun k => g k * Phi k).
  Proof.
    intros h body.
    assert (tensor_symmetric : forall i j, second_moments Phi i j = second_moments Phi j i).
    { intros i j. unfold second_moments, tensor, identity. destruct i, j; reflexivity. }
    pose proof (semidefinite_pairing 4 (cost_matrix g low) (pseudo_inertia_matrix Phi)
      (bordered_symmetric _ _ _ (twice_A_symmetric g))
      (bordered_symmetric _ _ _ tensor_symmetric)
      (cost_semidefinite g low h) (body_semidefinite Phi body)) as trace.
    rewrite cost_of_a_body in trace. apply le_of_sub.
    assert (half : 0 <= inv (2 : K)) by apply inv_nonneg, two_pos.
    pose proof (mul_nonneg _ _ half trace) as difference.
    match type of difference with 0 <= ?x => match goal with |- 0 <= ?y =>
      replace y with x; [exact difference |] end end.
    field. apply pos_nonzero, two_pos.
  Qed.

  (** The data term of any parameters, from any residual r. *)
  Lemma data_from_any_residual (p : MassProblem K) (r x : nat -> K) :
    data_of p x =
    constant_terms p r + 2 * sum (parameters p) (fun k => half_slope p r k * x k) +
    sum (rows p) (fun i => W p i * ((residual p x i - r i) * (residual p x i - r i))).
  Proof.
    assert (swapped : sum (parameters p) (fun k => half_slope p r k * x k) =
      sum (rows p) (fun i => W p i * r i * sum (parameters p) (fun k => Y p i k * x k))).
    { rewrite (sum_ext (rows p) _ (fun i => sum (parameters p) (fun k =>
        x k * (Y p i k * (W p i * r i))))).
      2: { intros i _. rewrite <- sum_scale. apply sum_ext. intros. ring. }
      rewrite sum_swap. apply sum_ext. intros k _. rewrite sum_scale. unfold half_slope. ring. }
    rewrite swapped, <- sum_scale. unfold constant_terms, data_of. rewrite <- !sum_add.
    apply sum_ext. intros i _. unfold residual. ring.
  Qed.

  (** Claim C18. No bodies that can exist, wherever they have mass, have a data term below
      - r^T W r - 2 F^T W r + 2 M min(0, lowest price in space), for any r; nor, so, has anything
      that shapes can make. *)
  Theorem bodies_are_above_the_floor (p : MassProblem K) r links M low x :
    well_formed p -> parameters p = (10 * links)%nat -> low <= 0 ->
    (forall l y, (l < links)%nat -> low <= price (half_slope p r) l y) ->
    all_consistent links x -> sum links (fun l => x (10 * l)%nat) <= M ->
    constant_terms p r + 2 * (M * low) <= data_of p x.
  Proof.
    intros wf ten hlow bound bodies total.
    assert (cost : M * low <= sum (parameters p) (fun k => half_slope p r k * x k)).
    { apply (le_trans _ (sum links (fun l => low * x (10 * l)%nat))).
      - rewrite sum_scale. apply le_of_sub.
        match goal with |- 0 <= low * ?s - M * low =>
          replace (low * s - M * low) with ((M - s) * - low) by ring end.
        apply mul_nonneg; [now apply sub_nonneg | now apply opp_nonneg].
      - rewrite ten, sum_tens. apply sum_le. intros l hl.
        pose proof (no_body_is_cheaper_than_a_point
          (fun k => half_slope p r (10 * l + k)%nat) low (fun k => x (10 * l + k)%nat)
          (fun y => bound l y hl) (bodies l hl)) as one.
        unfold mass in one. rewrite <- plus_n_O in one. exact one. }
    rewrite (data_from_any_residual p r x).
    match goal with |- ?a <= ?b + ?c + ?d => replace a with (b + 2 * (M * low) + 0) by ring end.
    apply le_add.
    - apply le_add; [apply le_refl |]. apply le_scale; [apply lt_le, two_pos | exact cost].
    - apply sum_nonneg. intros i hi. apply mul_nonneg; [apply lt_le; now apply wf | apply square_nonneg].
  Qed.
End BodiesFloor.
