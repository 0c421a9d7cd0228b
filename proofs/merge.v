(** Windows compressed to triangles and merged: nothing is lost, in whatever order. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums.

Section Merge.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** Rows of a window, [Y F]: a number of rows, and their entries. *)
  Record Rows := { count : nat; entry : nat -> nat -> K }.

  (** M x, with n columns *)
  Definition row_times (n : nat) (M : Rows) (x : nat -> K) (i : nat) : K :=
    sum n (fun k => entry M i k * x k).

  (** || M x ||^2 *)
  Definition sum_of_squares (n : nat) (M : Rows) (x : nat -> K) : K :=
    norm2 (count M) (row_times n M x).

  (** reference/triangle.hpp, stacked: one above the other. *)
  Definition stacked (A B : Rows) : Rows := {|
    count := count A + count B;
    entry := fun i k => if i <? count A then entry A i k else entry B (i - count A)%nat k
  |}.

  (** [R] can stand for [M]: the same sum of squares for every x. *)
  Definition compresses (n : nat) (R M : Rows) : Prop :=
    forall x, sum_of_squares n R x = sum_of_squares n M x.

  (** M = Q R with Q^T Q = 1: what a QR decomposition returns, R of any shape. *)
  Definition factored (n : nat) (M R : Rows) (Q : nat -> nat -> K) : Prop :=
    (forall i k, (i < count M)%nat -> (k < n)%nat ->
       entry M i k = sum (count R) (fun l => Q i l * entry R l k)) /\
    (forall l l', (l < count R)%nat -> (l' < count R)%nat ->
       sum (count M) (fun i => Q i l * Q i l') = if l =? l' then 1 else 0).

  (** Isometric columns keep sums of squares. *)
  Lemma isometry n k (Q : nat -> nat -> K) (y : nat -> K) :
    (forall l l', (l < k)%nat -> (l' < k)%nat ->
       sum n (fun i => Q i l * Q i l') = if l =? l' then 1 else 0) ->
    norm2 n (fun i => sum k (fun l => Q i l * y l)) = norm2 k y.
  Proof.
    intro orthonormal. unfold norm2, dot.
    transitivity (sum k (fun l => sum k (fun l' =>
      (y l * y l') * sum n (fun i => Q i l * Q i l')))).
    - rewrite (sum_ext n _ (fun i => sum k (fun l => sum k (fun l' =>
          (y l * y l') * (Q i l * Q i l'))))).
      + rewrite sum_swap. apply sum_ext. intros l _. rewrite sum_swap. apply sum_ext.
        intros l' _. apply sum_scale.
      + intros i _. rewrite <- sum_scale. apply sum_ext. intros l _.
        transitivity ((Q i l * y l) * sum k (fun l' => Q i l' * y l')); [ring |].
        rewrite <- sum_scale. apply sum_ext. intros. ring.
    - apply sum_ext. intros l hl.
      rewrite (sum_ext _ _ (fun l' => (if l =? l' then 1 else 0) * (y l * y l'))).
      + now apply (sum_indicator k l (fun l' => y l * y l')).
      + intros l' hl'. rewrite orthonormal by assumption. ring.
  Qed.

  (** Claim C8. A triangle from a QR decomposition can stand for its rows. *)
  Theorem triangle_compresses n M R Q : factored n M R Q -> compresses n R M.
  Proof.
    intros [product orthonormal] x. unfold sum_of_squares.
    rewrite <- (isometry (count M) (count R) Q (row_times n R x) orthonormal).
    apply sum_ext. intros i hi. unfold row_times.
    assert (e : sum n (fun k => entry M i k * x k) =
                sum (count R) (fun l => Q i l * sum n (fun k => entry R l k * x k))).
    { rewrite (sum_ext n _ (fun k => sum (count R) (fun l => Q i l * (entry R l k * x k)))).
      - rewrite sum_swap. apply sum_ext. intros. apply sum_scale.
      - intros k hk. rewrite product by assumption.
        transitivity (x k * sum (count R) (fun l => Q i l * entry R l k)); [ring |].
        rewrite <- sum_scale. apply sum_ext. intros. ring. }
    now rewrite e.
  Qed.

  (** Claim C8. Stacked rows: sums of squares add. *)
  Theorem stacked_adds n A B x :
    sum_of_squares n (stacked A B) x = sum_of_squares n A x + sum_of_squares n B x.
  Proof.
    unfold sum_of_squares, norm2, dot. cbn [count stacked]. rewrite sum_concat. f_equal.
    - apply sum_ext. intros i hi. unfold row_times. cbn [entry stacked].
      destruct (Nat.ltb_spec i (count A)); [reflexivity | lia].
    - apply sum_ext. intros i hi. unfold row_times. cbn [entry stacked].
      destruct (Nat.ltb_spec (count A + i) (count A)); [lia |].
      now replace (count A + i - count A)%nat with i by lia.
  Qed.

  (** Windows merge in a tree of any form: of what is compressed on the way, and when, nothing
      shows. *)
  Inductive merged (n : nat) : Rows -> Rows -> Prop :=
  | as_they_are M : merged n M M
  | compressed R R' M : merged n R M -> compresses n R' R -> merged n R' M
  | together RA RB A B : merged n RA A -> merged n RB B -> merged n (stacked RA RB) (stacked A B)
  | exchanged R A B : merged n R (stacked A B) -> merged n R (stacked B A).

  (** Claim C8. However windows are compressed and merged, all sums of squares stay. *)
  Theorem merging_is_exact n R M : merged n R M -> compresses n R M.
  Proof.
    induction 1 as [M | R R' M _ IH c | RA RB A B _ IHA _ IHB | R A B _ IH]; intro x.
    - reflexivity.
    - rewrite c. apply IH.
    - rewrite !stacked_adds. now rewrite IHA, IHB.
    - rewrite IH, !stacked_adds. ring.
  Qed.

  (** (x, -1): with rows [Y F] of n + 1 columns, [Y F] (Phi, -1) = Y Phi - F. *)
  Definition with_minus_one (n : nat) (Phi : nat -> K) (k : nat) : K :=
    if k <? n then Phi k else - (1).

  Definition data_term (n : nat) (M : Rows) (Phi : nat -> K) : K :=
    sum (count M) (fun i =>
      let r := sum n (fun k => entry M i k * Phi k) - entry M i n in r * r).

  (** Claim C8. So the data term of the mass problem, its constant included, is that of all rows. *)
  Theorem merging_keeps_the_data_term n R M Phi :
    merged (S n) R M -> data_term n R Phi = data_term n M Phi.
  Proof.
    intro h. apply merging_is_exact in h.
    assert (same : forall A, data_term n A Phi = sum_of_squares (S n) A (with_minus_one n Phi)).
    { intro A. unfold data_term, sum_of_squares, norm2, dot. apply sum_ext. intros i _. cbv zeta.
      assert (r : row_times (S n) A (with_minus_one n Phi) i =
                  sum n (fun k => entry A i k * Phi k) - entry A i n).
      { unfold row_times. cbn [sum]. unfold with_minus_one at 2. rewrite Nat.ltb_irrefl.
        rewrite (sum_ext n _ (fun k => entry A i k * Phi k)); [ring |].
        intros k hk. unfold with_minus_one. now destruct (Nat.ltb_spec k n); [| lia]. }
      now rewrite r. }
    rewrite !same. apply h.
  Qed.
End Merge.

Arguments Rows : clear implicits.
