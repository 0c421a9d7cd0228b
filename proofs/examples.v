(** The hypotheses of the theorems can be met, in every ordered field: small instances, and one
    where a hypothesis is needed. *)
From Coq Require Import Ring Field Arith Lia List QArith Qcanon.
From Shapeid Require Import ordered_field numbers sums space mass_problem kkt certificate projection
  projection_qr merge body floor distance.
Import ListNotations.

Section Examples.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  Lemma three_pos : (0 : K) < 3.
  Proof. apply add_pos; [apply one_pos | apply lt_le, two_pos]. Qed.

  (** (m0 + m1 - 1)^2 + m0^2 + m1^2: columns that are equal, so only lambda tells them apart. *)
  Definition two_equal_shapes : MassProblem K := {|
    rows := 1; parameters := 1; shapes := 2;
    Y := fun _ _ => 1; F := fun _ => 1; W := fun _ => 1; U := fun _ _ => 1; V := fun _ => 1;
    lambda := 1 |}.

  Example it_is_well_formed : well_formed two_equal_shapes /\ 0 < lambda two_equal_shapes.
  Proof.
    split; [split; [| split] |]; cbn; intros; apply one_pos.
  Qed.

  (** kkt_suffices and optimum_is_unique: a third each. *)
  Example its_optimum : kkt two_equal_shapes (fun _ => 1 / 3).
  Proof.
    assert (slope_zero : forall j, gradient two_equal_shapes (fun _ => 1 / 3) j = 0).
    { intro j. unfold gradient, slope, residual, Phi. cbn. field.
      repeat apply conj; (apply pos_nonzero, three_pos || apply one_neq_zero). }
    split.
    - intros j _. apply div_nonneg; [apply one_nonneg | apply three_pos].
    - intros j _. rewrite slope_zero. split; [apply le_refl | ring].
  Qed.

  (** Why M must belong to the problem. Taken from the answer m = 0 it is 0, the certificate then
      compares m with itself alone, and proves nothing: a third each is better. *)
  Example forged_mass_bound :
    (forall t, within two_equal_shapes 0 t ->
       objective two_equal_shapes (fun _ => 0) <= objective two_equal_shapes t) /\
    objective two_equal_shapes (fun _ => 1 / 3) < objective two_equal_shapes (fun _ => 0).
  Proof.
    split.
    - intros t [ht total].
      assert (none : forall j, (j < 2)%nat -> t j = 0).
      { intros j hj. apply (sum_nonneg_zero 2 t); [exact ht | | exact hj].
        apply le_antisym; [exact total | now apply sum_nonneg]. }
      assert (e : objective two_equal_shapes t = objective two_equal_shapes (fun _ => 0)).
      { unfold objective, data, data_of, density, residual, Phi. cbn.
        rewrite (none 0%nat), (none 1%nat) by lia. reflexivity. }
      rewrite e. apply le_refl.
    - apply (proj2 (lt_sub _ _)).
      assert (e : objective two_equal_shapes (fun _ => 0) -
                  objective two_equal_shapes (fun _ => 1 / 3) = 2 * inv 3).
      { unfold objective, data, data_of, density, residual, Phi. cbn. field.
        repeat apply conj; (apply pos_nonzero, three_pos || apply one_neq_zero). }
      rewrite e. apply mul_pos; [apply two_pos |].
      split; [apply inv_nonneg, three_pos |]. intro no. symmetry in no. revert no.
      apply inv_nonzero, pos_nonzero, three_pos.
  Qed.

  (** best_within with a bound that holds the optimum back: of no mass at all, nothing. *)
  Example no_mass_is_best_of_none : best_within two_equal_shapes 0 (fun _ => 0).
  Proof.
    split; [split |].
    - intros j _. apply le_refl.
    - cbn. replace (0 + 0 + 0 : K) with (0 : K) by ring. apply le_refl.
    - apply forged_mass_bound.
  Qed.

  (** contact_free with J^T that loses rank: two rows, one contact named twice. *)
  Definition named_twice (i l : nat) : K := if i =? 0 then 1 else 0.
  Definition what_is_left (i a : nat) : K := if i =? 1 then 1 else 0.

  Example basis_of_redundant_contacts : contact_free 2 2 1 named_twice what_is_left.
  Proof.
    split.
    - intros a b ha hb. replace a with 0%nat by lia. replace b with 0%nat by lia. cbn. ring.
    - intros a ha l hl. unfold dot. cbn. ring.
    - intros e h. exists (fun _ => e 1%nat). intros i hi.
      specialize (h 0%nat ltac:(lia)). unfold dot in h. cbn in h.
      destruct i as [| [| i]]; [| | lia]; unfold image; cbn.
      + transitivity (0 + 1 * e 0%nat + 0 * e 1%nat); [ring | rewrite h; ring].
      + ring.
  Qed.

  (** rank_revealing of the same: Q = 1, R P^T = (1 1). *)
  Example redundant_contacts_factor :
    rank_revealing 2 2 1 named_twice (fun i a => if i =? a then 1 else 0) (fun _ _ => 1)
      (fun l _ => if l =? 0 then 1 else 0).
  Proof.
    split; intros;
      repeat match goal with h : (?a < 2)%nat |- _ => destruct a as [| [| ?]];
          [clear h | clear h | lia]
                           | h : (?a < 1)%nat |- _ => destruct a as [| ?]; [clear h | lia] end;
      try lia; unfold dot, named_twice; cbn; ring.
  Qed.

  (** factored: the column (3, 4) is (3/5, 4/5) times 5. *)
  Definition four : K := 2 * 2.
  Definition five : K := four + 1.
  Definition column_of_two : Rows K :=
    {| count := 2; entry := fun i _ => if i =? 0 then 3 else four |}.
  Definition its_triangle : Rows K := {| count := 1; entry := fun _ _ => five |}.

  Example factors :
    factored 1 column_of_two its_triangle (fun i _ => (if i =? 0 then 3 else four) / five).
  Proof.
    assert (no : five <> 0).
    { apply pos_nonzero. apply add_pos; [| apply one_nonneg]. apply mul_pos; apply two_pos. }
    split.
    - intros i k _ _. cbn. field. exact no.
    - intros l l' hl hl'. cbn in hl, hl'.
      replace l with 0%nat by lia. replace l' with 0%nat by lia. cbn.
      rewrite !div_mul.
      transitivity (five * five * (inv five * inv five)); [unfold five, four; ring |].
      field. exact no.
  Qed.

  (** Bodies: finitely many particles that are not negative. *)
  Fixpoint particles (body : list (K * Vec3 K)) (f : Vec3 K -> K) : K :=
    match body with
    | [] => 0
    | (mu, x) :: rest => mu * f x + particles rest f
    end.

  Definition body_of (l : list (K * Vec3 K)) (h : forall mu x, In (mu, x) l -> 0 <= mu) : Body K.
  Proof.
    refine {| integrable := fun _ => True; integral := particles l |}.
    - intros f g e _. split; [trivial |]. clear h.
      induction l as [| [mu x] rest IH]; cbn; [reflexivity |]. now rewrite e, IH.
    - intros a b f g _ _. split; [trivial |]. clear h.
      induction l as [| [mu x] rest IH]; cbn; [ring |]. rewrite IH. ring.
    - intros f hf _. induction l as [| [mu x] rest IH]; cbn; [apply le_refl |].
      apply add_nonneg.
      + apply mul_nonneg; [| apply hf]. apply (h mu x). now left.
      + apply IH. intros mu' x' hx. apply (h mu' x'). now right.
    - repeat split; trivial.
  Defined.

  (** made_of and lies_in: one particle at the origin of link 0. *)
  Definition at_origin : list (K * Vec3 K) := [(1, fun _ => 0)].
  Lemma not_negative : forall mu x, In (mu, x) at_origin -> 0 <= mu.
  Proof. intros mu x [[= <- _] | []]. apply one_nonneg. Qed.
  Definition point_at_origin : Body K := body_of at_origin not_negative.

  Definition one_point : MassProblem K := {|
    rows := 1; parameters := 10; shapes := 1;
    Y := fun _ k => if k =? 0 then 1 else 0; F := fun _ => 1; W := fun _ => 1;
    U := fun k _ => body_parameters point_at_origin k; V := fun _ => body_volume point_at_origin;
    lambda := 1 |}.

  Example shapes_in_a_region :
    made_of one_point 1 (fun _ r => forall i, r i = 0) (fun _ => 0%nat) (fun _ => point_at_origin).
  Proof.
    assert (volume : body_volume point_at_origin = 1).
    { unfold body_volume. cbn. ring. }
    split.
    - reflexivity.
    - intros. lia.
    - intros j l k _ hl hk. replace l with 0%nat by lia. reflexivity.
    - intros. rewrite volume. apply one_pos.
    - intros j _ f low _ bound. rewrite volume. cbn.
      replace (low * 1) with low by ring.
      replace (1 * f (fun _ => 0) + 0) with (f (fun _ => 0)) by ring.
      now apply bound.
  Qed.

  (** cut_by: each particle goes to the side where it is. *)
  Definition part (side : Vec3 K -> K) (l : list (K * Vec3 K)) : list (K * Vec3 K) :=
    map (fun '(mu, x) => (mu * side x, x)) l.

  Lemma part_not_negative side l :
    (forall x, side x = 0 \/ side x = 1) -> (forall mu x, In (mu, x) l -> 0 <= mu) ->
    forall mu x, In (mu, x) (part side l) -> 0 <= mu.
  Proof.
    intros sides h mu x hx. apply in_map_iff in hx. destruct hx as [[mu' x'] [[= <- <-] hx]].
    apply mul_nonneg; [now apply (h mu' x') |].
    destruct (sides x') as [-> | ->]; [apply le_refl | apply one_nonneg].
  Qed.

  Lemma part_integral side l f : particles (part side l) f = particles l (fun x => side x * f x).
  Proof.
    unfold part. induction l as [| [mu x] rest IH]; cbn; [reflexivity |]. rewrite IH. ring.
  Qed.

  Lemma other_side (side : Vec3 K -> K) :
    (forall x, side x = 0 \/ side x = 1) -> forall x, 1 - side x = 0 \/ 1 - side x = 1.
  Proof. intros sides x. destruct (sides x) as [-> | ->]; [right | left]; ring. Qed.

  Example particles_on_two_sides side l
      (sides : forall x, side x = 0 \/ side x = 1) (h : forall mu x, In (mu, x) l -> 0 <= mu) :
    cut_by side (body_of l h)
      (body_of (part side l) (part_not_negative side l sides h))
      (body_of (part (fun x => 1 - side x) l) (part_not_negative _ l (other_side side sides) h)).
  Proof.
    split; [exact sides |]. split; [now split |]. split; [now cbn |].
    split; intros f _; apply part_integral.
  Qed.
End Examples.

(** The side of the plane n . x = d, over the rationals: as particles_on_two_sides takes it. *)
Definition side_of_plane (n : Vec3 rationals) (d : rationals) (x : Vec3 rationals) : rationals :=
  if Qclt_le_dec d (dot3 n x) then zero else one.

Example planes_have_two_sides n d x : side_of_plane n d x = zero \/ side_of_plane n d x = one.
Proof. unfold side_of_plane. destruct (Qclt_le_dec d (dot3 n x)); auto. Qed.

(** The theorems over the two fields that are used: nothing but the field changes. *)
Definition kkt_over_the_reals := @kkt_suffices reals.
Definition kkt_over_the_rationals := @kkt_suffices rationals.
