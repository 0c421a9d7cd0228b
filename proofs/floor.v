(** How good division can get: a floor for every set of shapes inside given regions, so for
    infinitely many divisions too (design, "How good can division get?"). *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums space mass_problem body.

Section Floor.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p q : MassProblem K) (x m t : nat -> K).

  (** The shapes of [p] are bodies of positive volume, each in the region of its link. *)
  Record made_of p (links : nat) (region : nat -> Vec3 K -> Prop)
      (link : nat -> nat) (shape : nat -> Body K) : Prop := {
    ten_each : parameters p = (10 * links)%nat;
    on_a_link : forall j, (j < shapes p)%nat -> (link j < links)%nat;
    own_rows : forall j l k, (j < shapes p)%nat -> (l < links)%nat -> (k < 10)%nat ->
      U p (10 * l + k)%nat j = if link j =? l then body_parameters (shape j) k else 0;
    some_volume : forall j, (j < shapes p)%nat -> 0 < body_volume (shape j);
    inside : forall j, (j < shapes p)%nat -> lies_in (region (link j)) (shape j)
  }.

  (** Same rows, weights and right-hand side; other shapes, and perhaps another lambda. *)
  Definition same_rows p q : Prop :=
    rows q = rows p /\ parameters q = parameters p /\
    (forall i k, Y q i k = Y p i k) /\ (forall i, F q i = F p i /\ W q i = W p i).

  (** What a unit point mass at [r] of a link changes the data term by, to first order: a quadratic
      polynomial in r. *)
  Definition price (g : nat -> K) (l : nat) (r : Vec3 K) : K :=
    sum 10 (fun k => g (10 * l + k)%nat * point_parameters r k).

  (** The floor from parameters [x], whether of the present masses or of any others: [low] is at
      most every price in every region, and at most zero; M is the bound of the total mass. *)
  Definition floor p x M low : K :=
    data_of p x - dot (parameters p) (slope p x) x + M * low.

  Lemma price_of_a_body region (B : Body K) (g : nat -> K) l low :
    0 < body_volume B -> lies_in region B -> (forall r, region r -> low <= price g l r) ->
    low <= sum 10 (fun k => g (10 * l + k)%nat * body_parameters B k).
  Proof.
    intros v h bound.
    destruct (integral_of_parameters B (fun k => g (10 * l + k)%nat) 10) as [hi he].
    pose proof (h _ low hi bound) as mean. rewrite he in mean.
    apply le_of_sub.
    assert (form : sum 10 (fun k => g (10 * l + k)%nat * body_parameters B k) - low =
      (sum 10 (fun k => g (10 * l + k)%nat * integral B (fun r => point_parameters r k)) -
       low * body_volume B) / body_volume B).
    { rewrite (sum_ext 10 _ (fun k => inv (body_volume B) *
        (g (10 * l + k)%nat * integral B (fun r => point_parameters r k)))).
      - rewrite sum_scale. field. now apply pos_nonzero.
      - intros k _. unfold body_parameters. rewrite div_mul. ring. }
    rewrite form. apply div_nonneg; [now apply sub_nonneg | exact v].
  Qed.

  (** The price of a shape's column, whatever the slopes g of the parameters. *)
  Lemma column_price q links region link shape (g : nat -> K) j :
    made_of q links region link shape -> (j < shapes q)%nat ->
    sum (parameters q) (fun k => g k * U q k j) =
    sum 10 (fun k => g (10 * link j + k)%nat * body_parameters (shape j) k).
  Proof.
    intros made hj. rewrite (ten_each _ _ _ _ _ made), sum_tens.
    rewrite (sum_ext links _ (fun l => (if link j =? l then 1 else 0) *
      sum 10 (fun k => g (10 * l + k)%nat * body_parameters (shape j) k))).
    - rewrite (sum_indicator links (link j) (fun l =>
        sum 10 (fun k => g (10 * l + k)%nat * body_parameters (shape j) k))); [reflexivity |].
      now apply (on_a_link _ _ _ _ _ made).
    - intros l hl. rewrite <- sum_scale. apply sum_ext. intros k hk.
      rewrite (own_rows _ _ _ _ _ made) by assumption. destruct (link j =? l); ring.
  Qed.

  (** Claim C15. Nothing that can be made of shapes in the regions, however many, is below the
      floor. *)
  Theorem floor_is_a_floor p q x links region link shape M low :
    well_formed p -> well_formed q -> same_rows p q -> made_of q links region link shape ->
    low <= 0 -> (forall l r, (l < links)%nat -> region l r -> low <= price (slope p x) l r) ->
    forall t, nonnegative q t -> sum (shapes q) t <= M -> floor p x M low <= objective q t.
  Proof.
    intros wfp wfq [er [ep [ey efw]]] made hlow bound t ht total.
    assert (same : forall y, data_of q y = data_of p y).
    { intro y. unfold data_of. rewrite er. apply sum_ext. intros i _.
      destruct (efw i) as [ef ew]. rewrite ew.
      assert (r : residual q y i = residual p y i).
      { unfold residual. rewrite ef, ep. f_equal. apply sum_ext. intros. now rewrite ey. }
      now rewrite r. }
    unfold objective, data. rewrite same, (data_expands p x). unfold floor.
    set (g := slope p x).
    (* The price of the masses t is at least M low. *)
    assert (bill : M * low <= dot (parameters p) g (Phi q t)).
    { assert (split : dot (parameters p) g (Phi q t) =
        sum (shapes q) (fun j => t j * sum 10 (fun k =>
          g (10 * link j + k)%nat * body_parameters (shape j) k))).
      { unfold dot, Phi. rewrite <- ep.
        rewrite (sum_ext (parameters q) _
          (fun k => sum (shapes q) (fun j => t j * (g k * U q k j)))).
        2: { intros k _. rewrite <- sum_scale. apply sum_ext. intros. ring. }
        rewrite sum_swap. apply sum_ext. intros j hj. rewrite sum_scale. f_equal.
        now apply (column_price q links region). }
      rewrite split. apply (le_trans _ (sum (shapes q) t * low)).
      - apply le_of_sub. replace (sum (shapes q) t * low - M * low) with
          ((M - sum (shapes q) t) * - low) by ring.
        apply mul_nonneg; [now apply sub_nonneg | now apply opp_nonneg].
      - replace (sum (shapes q) t * low) with (low * sum (shapes q) t) by ring.
        rewrite <- sum_scale. apply sum_le. intros j hj.
        replace (low * t j) with (t j * low) by ring. apply le_scale; [now apply ht |].
        apply (price_of_a_body (region (link j))).
        + now apply (some_volume _ _ _ _ _ made).
        + now apply (inside _ _ _ _ _ made).
        + intros r hr. apply bound; [now apply (on_a_link _ _ _ _ _ made) | exact hr]. }
    assert (slopes : sum (parameters p) (fun k => g k * (Phi q t k - x k)) =
                     dot (parameters p) g (Phi q t) - dot (parameters p) g x).
    { unfold dot. rewrite <- sum_sub. apply sum_ext. intros. ring. }
    rewrite slopes. apply le_of_sub.
    match goal with |- 0 <= ?a + (?b - ?c) + ?d + ?e - (?a - ?c + ?f) =>
      replace (a + (b - c) + d + e - (a - c + f)) with ((b - f) + d + e) by ring end.
    apply add_nonneg; [apply add_nonneg |].
    - now apply sub_nonneg.
    - now apply curvature_nonneg.
    - unfold density. apply mul_nonneg; [apply wfq |]. apply sum_nonneg. intros j hj.
      apply div_nonneg; [apply square_nonneg | now apply wfq].
  Qed.

  (** z at lambda = 0: the prices of the present shapes. *)
  Definition shape_price p m (j : nat) : K :=
    sum (parameters p) (fun k => U p k j * slope p (Phi p m) k).

  (** Claim C15. The gap of the present masses to any number of divisions is at most
      <z, m> - M min(0, lowest price). *)
  Theorem gap_to_infinitely_many_divisions p q m links region link shape M low :
    well_formed p -> well_formed q -> same_rows p q -> made_of q links region link shape ->
    low <= 0 ->
    (forall l r, (l < links)%nat -> region l r -> low <= price (slope p (Phi p m)) l r) ->
    forall t, nonnegative q t -> sum (shapes q) t <= M ->
    data p m - objective q t <= sum (shapes p) (fun j => shape_price p m j * m j) - M * low.
  Proof.
    intros wfp wfq same made hlow bound t ht total.
    pose proof (floor_is_a_floor p q (Phi p m) links region link shape M low wfp wfq same made hlow
                  bound t ht total) as h.
    unfold floor in h. fold (data p m) in h.
    assert (bill : dot (parameters p) (slope p (Phi p m)) (Phi p m) =
                   sum (shapes p) (fun j => shape_price p m j * m j)).
    { unfold dot, shape_price. unfold Phi at 2.
      rewrite (sum_ext (parameters p) _ (fun k => sum (shapes p) (fun j =>
        m j * (U p k j * slope p (Phi p m) k)))).
      - rewrite sum_swap. apply sum_ext. intros j _. rewrite sum_scale. ring.
      - intros k _. rewrite <- sum_scale. apply sum_ext. intros. ring. }
    rewrite bill in h. apply le_of_sub. apply sub_nonneg in h.
    match goal with |- 0 <= ?a => match type of h with 0 <= ?b =>
      replace a with b by ring end end. exact h.
  Qed.
End Floor.
