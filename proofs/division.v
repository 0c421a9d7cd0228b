(** A division from end to end: a shape of a mass problem is cut, with the volumes and columns that
    the parts really have, and nothing changes. split.v says why, cuboid.v and body.v that parts
    add up. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem split space cuboid body.

Section Division.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m : nat -> K).

  (** The problem with shape [j] replaced by two: the first in its place, the second appended. *)
  Definition with_parts p (j : nat) (v1 : K) (u1 : nat -> K) (v2 : K)
      (u2 : nat -> K) : MassProblem K :=
    {| rows := rows p; parameters := parameters p; shapes := S (shapes p);
       Y := Y p; F := F p; W := W p; lambda := lambda p;
       U := fun k i => if i =? j then u1 k else if i =? shapes p then u2 k else U p k i;
       V := fun i => if i =? j then v1 else if i =? shapes p then v2 else V p i |}.

  Lemma with_parts_is_cut p j v1 u1 v2 u2 :
    (j < shapes p)%nat -> 0 < v1 -> 0 < v2 -> V p j = v1 + v2 ->
    (forall k, V p j * U p k j = v1 * u1 k + v2 * u2 k) ->
    cut p (with_parts p j v1 u1 v2 u2) j.
  Proof.
    intros hj p1 p2 ev eu.
    assert (last : shapes p =? j = false) by (apply Nat.eqb_neq; lia).
    constructor; cbn; rewrite ?Nat.eqb_refl, ?last; auto.
    - intros k i hi no. apply Nat.eqb_neq in no. rewrite no.
      destruct (Nat.eqb_spec i (shapes p)); [lia | reflexivity].
    - intros i hi no. apply Nat.eqb_neq in no. rewrite no.
      destruct (Nat.eqb_spec i (shapes p)); [lia | reflexivity].
  Qed.

  (** The column of a shape on a link: its ten numbers in the link's ten rows. *)
  Definition column (link : nat) (u : Ten K) (k : nat) : K :=
    if k / 10 =? link then u (k mod 10)%nat else 0.

  Lemma columns_add_up link v u v1 u1 v2 u2 :
    (forall k, v * u k = v1 * u1 k + v2 * u2 k) ->
    forall k, v * column link u k = v1 * column link u1 k + v2 * column link u2 k.
  Proof. intros h k. unfold column. destruct (k / 10 =? link); [apply h | ring]. Qed.

  (** What a division may not change. *)
  Definition unchanged p q m t : Prop :=
    (forall k, Phi q t k = Phi p m k) /\ density q t = density p m /\ objective q t = objective p m.

  Lemma cut_changes_nothing p q j m : cut p q j -> unchanged p q m (equal_density p q j m).
  Proof.
    intro c. split; [| split].
    - intro k. now apply split_keeps_parameters.
    - now apply split_keeps_density.
    - now apply split_keeps_objective.
  Qed.

  (** Claim C4. A cuboid anywhere on any link, cut across any axis at any place. *)
  Theorem cuboid_division_changes_nothing p j link T c axis s m :
    let whole := moments_of T c in
    let part1 := moments_of T (below c axis s) in
    let part2 := moments_of T (above c axis s) in
    let q := with_parts p j (volume part1) (column link (unit_parameters part1))
                            (volume part2) (column link (unit_parameters part2)) in
    (j < shapes p)%nat -> V p j = volume whole ->
    (forall k, U p k j = column link (unit_parameters whole) k) ->
    solid T c -> lower c axis < s -> s < upper c axis ->
    unchanged p q m (equal_density p q j m).
  Proof.
    intros whole part1 part2 q hj ev eu hs below above.
    destruct (cuboid_cut T c axis s hs below above) as [volumes [p1 [p2 add]]].
    apply cut_changes_nothing. apply with_parts_is_cut; try assumption.
    - rewrite ev. exact volumes.
    - intro k. rewrite ev, eu. apply columns_add_up. exact add.
  Qed.

  (** Claim C4. Any body on any link, cut by a plane or by anything else that leaves two volumes. *)
  Theorem body_division_changes_nothing p j link side (B B1 B2 : Body K) m :
    let q := with_parts p j (body_volume B1) (column link (body_parameters B1))
                            (body_volume B2) (column link (body_parameters B2)) in
    (j < shapes p)%nat -> V p j = body_volume B ->
    (forall k, U p k j = column link (body_parameters B) k) ->
    cut_by side B B1 B2 -> 0 < body_volume B1 -> 0 < body_volume B2 ->
    unchanged p q m (equal_density p q j m).
  Proof.
    intros q hj ev eu c v1 v2.
    apply cut_changes_nothing. apply with_parts_is_cut; try assumption.
    - rewrite ev. now apply (moments_add_up side).
    - intro k. rewrite ev, eu. apply columns_add_up. intro. now apply (body_cut side).
  Qed.
End Division.
