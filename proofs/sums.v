(** Finite sums, and vectors as functions of an index of which the first n count. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field.

Section Sums.
  Variable K : OrderedField.
  Add Field numbers : (field_laws K).

  (** f 0 + ... + f (n - 1) *)
  Fixpoint sum (n : nat) (f : nat -> K) : K :=
    match n with
    | O => 0
    | S k => sum k f + f k
    end.

  Definition dot (n : nat) (x y : nat -> K) : K := sum n (fun i => x i * y i).
  Definition norm2 (n : nat) (x : nat -> K) : K := dot n x x.

  Lemma sum_ext n f g : (forall i, (i < n)%nat -> f i = g i) -> sum n f = sum n g.
  Proof.
    induction n as [| n IH]; intro h; [reflexivity | simpl].
    rewrite IH, h; auto.
  Qed.

  Lemma sum_zero n : sum n (fun _ => 0) = 0.
  Proof. induction n as [| n IH]; simpl; [reflexivity | rewrite IH; ring]. Qed.

  Lemma sum_add n f g : sum n (fun i => f i + g i) = sum n f + sum n g.
  Proof. induction n as [| n IH]; simpl; [ring | rewrite IH; ring]. Qed.

  Lemma sum_sub n f g : sum n (fun i => f i - g i) = sum n f - sum n g.
  Proof. induction n as [| n IH]; simpl; [ring | rewrite IH; ring]. Qed.

  Lemma sum_scale n c f : sum n (fun i => c * f i) = c * sum n f.
  Proof. induction n as [| n IH]; simpl; [ring | rewrite IH; ring]. Qed.

  Lemma sum_swap n k f :
    sum n (fun i => sum k (fun j => f i j)) = sum k (fun j => sum n (fun i => f i j)).
  Proof.
    induction n as [| n IH]; simpl; [symmetry; apply sum_zero |].
    rewrite IH. symmetry. apply sum_add.
  Qed.

  Lemma sum_nonneg n f : (forall i, (i < n)%nat -> 0 <= f i) -> 0 <= sum n f.
  Proof.
    induction n as [| n IH]; intro h; simpl; [apply le_refl |].
    apply add_nonneg; auto.
  Qed.

  Lemma sum_le n f g : (forall i, (i < n)%nat -> f i <= g i) -> sum n f <= sum n g.
  Proof.
    induction n as [| n IH]; intro h; simpl; [apply le_refl |].
    apply le_add; auto.
  Qed.

  Lemma sum_nonneg_zero n f :
    (forall i, (i < n)%nat -> 0 <= f i) -> sum n f = 0 -> forall i, (i < n)%nat -> f i = 0.
  Proof.
    induction n as [| n IH]; intros h e i hi; [lia | simpl in e].
    assert (rest : 0 <= sum n f) by (apply sum_nonneg; auto).
    assert (last : f n = 0).
    { apply (add_zero (f n) (sum n f)); auto. rewrite <- e. ring. }
    destruct (Nat.eq_dec i n) as [-> | no]; [exact last |].
    apply IH; [auto | | lia].
    rewrite <- e, last. ring.
  Qed.

  (** Place j takes another value and one more term is appended. *)
  Lemma sum_split n j f g :
    (j < n)%nat -> g j + g n = f j -> (forall i, (i < n)%nat -> i <> j -> g i = f i) ->
    sum (S n) g = sum n f.
  Proof.
    simpl. revert g. induction n as [| n IH]; intros g hj e others; [lia | simpl].
    destruct (Nat.eq_dec j n) as [-> | no].
    - rewrite (sum_ext n g f) by (intros i hi; apply others; lia). rewrite <- e. ring.
    - rewrite (others n) by lia.
      transitivity (sum n g + g (S n) + f n); [ring |]. f_equal.
      pose (g' := fun i => if i =? n then g (S n) else g i).
      assert (below : forall i, (i < n)%nat -> g' i = g i).
      { intros i hi. unfold g'. destruct (Nat.eqb_spec i n); [lia | reflexivity]. }
      assert (at_n : g' n = g (S n)) by (unfold g'; now rewrite Nat.eqb_refl).
      rewrite <- (sum_ext n g' g) by exact below. rewrite <- at_n.
      apply IH; [lia | rewrite at_n, below by lia; exact e |].
      intros i hi hij. rewrite below by exact hi. apply others; lia.
  Qed.

  Lemma sum_concat a b f : sum (a + b) f = sum a f + sum b (fun i => f (a + i)%nat).
  Proof.
    induction b as [| b IH].
    - rewrite Nat.add_0_r. cbn [sum]. ring.
    - rewrite Nat.add_succ_r. cbn [sum]. rewrite IH. ring.
  Qed.

  Lemma sum_indicator n l f :
    (l < n)%nat -> sum n (fun k => (if l =? k then 1 else 0) * f k) = f l.
  Proof.
    induction n as [| n IH]; intro hl; [lia | cbn [sum]].
    destruct (Nat.eqb_spec l n) as [-> | no].
    - rewrite (sum_ext _ _ (fun _ => 0)).
      + rewrite sum_zero. ring.
      + intros k hk. destruct (Nat.eqb_spec n k); [lia | ring].
    - rewrite IH by lia. ring.
  Qed.

  (** Ten numbers a link. *)
  Lemma sum_tens n f : sum (10 * n) f = sum n (fun l => sum 10 (fun k => f (10 * l + k)%nat)).
  Proof.
    induction n as [| n IH]; [reflexivity |].
    replace (10 * S n)%nat with (10 * n + 10)%nat by lia. rewrite sum_concat, IH. reflexivity.
  Qed.

  Lemma dot_comm n x y : dot n x y = dot n y x.
  Proof. apply sum_ext. intros. ring. Qed.

  Lemma norm2_nonneg n x : 0 <= norm2 n x.
  Proof. apply sum_nonneg. intros. apply square_nonneg. Qed.

  Lemma norm2_zero n x : norm2 n x = 0 -> forall i, (i < n)%nat -> x i = 0.
  Proof.
    intros e i hi. apply square_zero.
    apply (sum_nonneg_zero n (fun k => x k * x k));
        [intros; apply square_nonneg | exact e | exact hi].
  Qed.
End Sums.

Arguments sum {K}.
Arguments dot {K}.
Arguments norm2 {K}.
Arguments sum_ext {K}.
Arguments sum_zero {K}.
Arguments sum_add {K}.
Arguments sum_sub {K}.
Arguments sum_scale {K}.
Arguments sum_swap {K}.
Arguments sum_nonneg {K}.
Arguments sum_le {K}.
Arguments sum_nonneg_zero {K}.
Arguments sum_split {K}.
Arguments sum_concat {K}.
Arguments sum_indicator {K}.
Arguments sum_tens {K}.
Arguments dot_comm {K}.
Arguments norm2_nonneg {K}.
Arguments norm2_zero {K}.
