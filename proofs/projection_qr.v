(** (7) and (8) as published and as reference/projection.cpp computes them: a rank-revealing QR of
    W^(1/2) J^T gives a basis that projection.v speaks of. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums projection.

Section Qr.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** A = W^(1/2) J^T, n x k, is [Q1 Q2] [R; 0] P^T: Q (n x n) orthogonal, its first [rank] columns
      are Q1, and R P^T (rank x k) has full row rank, being given with a right inverse [X]. *)
  Record rank_revealing (n k rank : nat) (A Q RP X : nat -> nat -> K) : Prop := {
    rank_fits : (rank <= n)%nat;
    columns_orthonormal : forall a b, (a < n)%nat -> (b < n)%nat ->
      dot n (fun i => Q i a) (fun i => Q i b) = if a =? b then 1 else 0;
    rows_orthonormal : forall i i', (i < n)%nat -> (i' < n)%nat ->
      sum n (fun a => Q i a * Q i' a) = if i =? i' then 1 else 0;
    is_product : forall i l, (i < n)%nat -> (l < k)%nat ->
      A i l = sum rank (fun a => Q i a * RP a l);
    full_row_rank : forall a b, (a < rank)%nat -> (b < rank)%nat ->
      sum k (fun l => RP a l * X l b) = if a =? b then 1 else 0
  }.

  (** Claim C2. The last columns of Q are orthonormal, reached by no force, and span what no force
      reaches, whatever the rank. *)
  Theorem qr_gives_a_contact_free_basis n k rank A Q RP X :
    rank_revealing n k rank A Q RP X ->
    contact_free n k (n - rank) A (fun i a => Q i (rank + a)%nat).
  Proof.
    intro qr. pose proof (rank_fits _ _ _ _ _ _ _ qr) as fits. split.
    - intros a b ha hb.
      rewrite (columns_orthonormal _ _ _ _ _ _ _ qr) by lia.
      destruct (Nat.eqb_spec (rank + a) (rank + b)), (Nat.eqb_spec a b); try reflexivity; lia.
    - intros a ha l hl. unfold dot.
      rewrite (sum_ext n _ (fun i => sum rank (fun b => RP b l * (Q i b * Q i (rank + a)%nat)))).
      2: { intros i hi. rewrite (is_product _ _ _ _ _ _ _ qr) by assumption.
           transitivity (Q i (rank + a)%nat * sum rank (fun b => Q i b * RP b l)); [ring |].
           rewrite <- sum_scale. apply sum_ext. intros. ring. }
      rewrite sum_swap, (sum_ext rank _ (fun _ => 0)); [apply sum_zero |].
      intros b hb. rewrite sum_scale.
      pose proof (columns_orthonormal _ _ _ _ _ _ _ qr b (rank + a)%nat) as o. unfold dot in o.
      rewrite o by lia. destruct (Nat.eqb_spec b (rank + a)); [lia | ring].
    - intros e normal.
      (* Coordinates of e in the columns of Q; those in Q1 are zero. *)
      pose (c := fun a => dot n (fun i => Q i a) e).
      assert (none : forall b, (b < rank)%nat -> c b = 0).
      { intros b hb.
        transitivity (sum k (fun l => X l b * dot n (fun i => A i l) e)).
        2: { rewrite (sum_ext k _ (fun _ => 0)); [apply sum_zero |].
             intros l hl. rewrite normal by exact hl. ring. }
        assert (columns : forall l, (l < k)%nat ->
                  dot n (fun i => A i l) e = sum rank (fun a => RP a l * c a)).
        { intros l hl. unfold dot, c.
          rewrite (sum_ext n _ (fun i => sum rank (fun a => RP a l * (Q i a * e i)))).
          2: { intros i hi. rewrite (is_product _ _ _ _ _ _ _ qr) by assumption.
               transitivity (e i * sum rank (fun a => Q i a * RP a l)); [ring |].
               rewrite <- sum_scale. apply sum_ext. intros. ring. }
          rewrite sum_swap. apply sum_ext. intros. apply sum_scale. }
        rewrite (sum_ext k _ (fun l => sum rank (fun a => c a * (RP a l * X l b)))).
        2: { intros l hl. rewrite columns by exact hl. rewrite <- sum_scale.
             apply sum_ext. intros. ring. }
        rewrite sum_swap, (sum_ext rank _ (fun a => (if b =? a then 1 else 0) * c a)).
        2: { intros a ha. rewrite sum_scale, (full_row_rank _ _ _ _ _ _ _ qr) by assumption.
             rewrite Nat.eqb_sym. destruct (b =? a); ring. }
        now rewrite (sum_indicator rank b c). }
      exists (fun a => c (rank + a)%nat). intros i hi. unfold image.
      transitivity (sum n (fun a => Q i a * c a)).
      + unfold c, dot.
        rewrite (sum_ext n _ (fun a => sum n (fun i' => e i' * (Q i a * Q i' a)))).
        2: { intros a _. rewrite <- sum_scale. apply sum_ext. intros. ring. }
        rewrite sum_swap, (sum_ext n _ (fun i' => (if i =? i' then 1 else 0) * e i')).
        * now rewrite (sum_indicator n i e).
        * intros i' hi'. rewrite sum_scale, (rows_orthonormal _ _ _ _ _ _ _ qr) by assumption.
          destruct (i =? i'); ring.
      + replace n with (rank + (n - rank))%nat at 1 by lia. rewrite sum_concat.
        rewrite (sum_ext rank _ (fun _ => 0)), sum_zero; [ring |].
        intros a ha. rewrite none by exact ha. ring.
  Qed.
End Qr.
