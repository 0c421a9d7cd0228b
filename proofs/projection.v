(** Contact forces are eliminated, and nothing else: (7) to (9) any weight, J of any rank. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums.

Section Projection.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (A : nat -> nat -> K) (x f : nat -> K).

  (** A f for A with k columns *)
  Definition image (k : nat) A f (i : nat) : K := sum k (fun l => A i l * f l).

  (** A^T e = 0: e is at right angles to the k columns of A (n rows). *)
  Definition normal_to (n k : nat) A (e : nat -> K) : Prop :=
    forall l, (l < k)%nat -> dot n (fun i => A i l) e = 0.

  Lemma dot_sub_l n x y z : dot n (fun i => x i - y i) z = dot n x z - dot n y z.
  Proof.
    unfold dot. rewrite <- sum_sub. apply sum_ext. intros. ring.
  Qed.

  Lemma dot_image n k A f (e : nat -> K) :
    dot n (image k A f) e = sum k (fun l => f l * dot n (fun i => A i l) e).
  Proof.
    unfold dot, image.
    rewrite (sum_ext n _ (fun i => sum k (fun l => f l * (A i l * e i)))).
    - rewrite sum_swap. apply sum_ext. intros. apply sum_scale.
    - intros i _. transitivity (e i * sum k (fun l => A i l * f l)); [ring |].
      rewrite <- sum_scale. apply sum_ext. intros. ring.
  Qed.

  Lemma normal_to_image n k A f (e : nat -> K) :
    normal_to n k A e -> dot n (image k A f) e = 0.
  Proof.
    intro h. rewrite dot_image, (sum_ext _ _ (fun _ => 0)); [apply sum_zero |].
    intros l hl. rewrite h by exact hl. ring.
  Qed.

  (** Whatever the rank of A, some f makes x - A f normal to all its columns: column by column, each
      first freed of those before it. A column that depends on those before it needs no force. *)
  Lemma best_force_exists n k A x :
    exists f, normal_to n k A (fun i => x i - image k A f i).
  Proof.
    revert x. induction k as [| k IH]; intro x.
    - exists (fun _ => 0). intros l hl. lia.
    - destruct (IH x) as [f hf]. destruct (IH (fun i => A i k)) as [g hg].
      set (e := fun i => x i - image k A f i) in *.
      set (a := fun i => A i k - image k A g i) in *.
      (* c is how much of the freed column a is taken from e. *)
      assert (taken : exists c, dot n (fun i => A i k) (fun i => e i - c * a i) = 0).
      { assert (ka : forall c, dot n (fun i => A i k) (fun i => e i - c * a i) =
                               dot n a e - c * dot n a a).
        { intro c.
          transitivity (dot n a (fun i => e i - c * a i) +
                        dot n (image k A g) (fun i => e i - c * a i)).
          { unfold dot. rewrite <- sum_add. apply sum_ext. intros. unfold a. ring. }
          rewrite (normal_to_image n k A g).
          2: { intros l hl. transitivity (dot n (fun i => A i l) e - c * dot n (fun i => A i l) a).
               - unfold dot. rewrite <- sum_scale, <- sum_sub. apply sum_ext. intros. ring.
               - rewrite (hf l hl), (hg l hl). ring. }
          unfold dot at 1 3. rewrite <- sum_scale. unfold dot.
          transitivity (sum n (fun i => a i * e i - c * (a i * a i)) + 0).
          - f_equal. apply sum_ext. intros. ring.
          - rewrite sum_sub. ring. }
        destruct (eq_decided (dot n a a) 0) as [zero | no].
        - exists 0. rewrite ka, zero.
          assert (ae : dot n a e = 0).
          { unfold dot. rewrite (sum_ext _ _ (fun _ => 0)); [apply sum_zero |].
            intros i hi. rewrite (norm2_zero n a zero i hi). ring. }
          rewrite ae. ring.
        - exists (dot n a e / dot n a a). rewrite ka. field. exact no. }
      destruct taken as [c hc].
      exists (fun l => if l =? k then c else f l - c * g l).
      assert (same : forall i,
        x i - image (S k) A (fun l => if l =? k then c else f l - c * g l) i =
                               e i - c * a i).
      { intro i. unfold e, a, image. cbn [sum]. rewrite Nat.eqb_refl.
        rewrite (sum_ext k _ (fun l => A i l * f l - c * (A i l * g l))).
        - rewrite sum_sub, sum_scale. ring.
        - intros l hl. destruct (Nat.eqb_spec l k); [lia | ring]. }
      intros l hl. unfold dot. rewrite (sum_ext _ _ (fun i => A i l * (e i - c * a i))).
      2: { intros i _. now rewrite same. }
      destruct (Nat.eq_dec l k) as [-> | no]; [exact hc |].
      transitivity (dot n (fun i => A i l) e - c * dot n (fun i => A i l) a).
      + unfold dot. rewrite <- sum_scale, <- sum_sub. apply sum_ext. intros. ring.
      + rewrite (hf l) by lia. rewrite (hg l) by lia. ring.
  Qed.

  (** Pythagoras: where x - A f is normal to A's columns, no other force does better. *)
  Lemma normal_is_best n k A x f g :
    normal_to n k A (fun i => x i - image k A f i) ->
    norm2 n (fun i => x i - image k A f i) <= norm2 n (fun i => x i - image k A g i).
  Proof.
    intro h. set (e := fun i => x i - image k A f i) in *.
    set (d := fun l => f l - g l).
    assert (form : norm2 n (fun i => x i - image k A g i) =
                   norm2 n e + 2 * dot n (image k A d) e + norm2 n (image k A d)).
    { unfold norm2, dot. rewrite <- sum_scale, <- !sum_add. apply sum_ext. intros i _.
      assert (split : image k A d i = image k A f i - image k A g i).
      { unfold image, d. rewrite <- sum_sub. apply sum_ext. intros. ring. }
      rewrite split. unfold e. ring. }
    rewrite form, (normal_to_image n k A d e h). apply le_of_sub.
    match goal with |- 0 <= ?a => replace a with (norm2 n (image k A d)) by ring end.
    apply norm2_nonneg.
  Qed.

  (** reference/projection.hpp, ContactFreeBasis: [Q2] has [q] orthonormal columns that span what is
      normal to the columns of A = W^(1/2) J^T. It is unique up to a rotation only. *)
  Record contact_free (n k q : nat) A (Q2 : nat -> nat -> K) : Prop := {
    orthonormal : forall a b, (a < q)%nat -> (b < q)%nat ->
      dot n (fun i => Q2 i a) (fun i => Q2 i b) = if a =? b then 1 else 0;
    no_force : forall a, (a < q)%nat -> normal_to n k A (fun i => Q2 i a);
    spans : forall e, normal_to n k A e ->
      exists c, forall i, (i < n)%nat -> e i = image q Q2 c i
  }.

  (** Q2^T x *)
  Definition projected (n : nat) (Q2 : nat -> nat -> K) x (a : nat) : K :=
    dot n (fun i => Q2 i a) x.

  Section OneSample.
    Variables (n k q : nat) (A Q2 : nat -> nat -> K).
    Hypothesis basis : contact_free n k q A Q2.

    Lemma projected_image f a : (a < q)%nat -> projected n Q2 (image k A f) a = 0.
    Proof.
      intro ha. unfold projected. rewrite dot_comm.
      apply normal_to_image. now apply (no_force _ _ _ _ _ basis).
    Qed.

    (** Claim C2. No contact force survives the projection. *)
    Theorem projection_removes_forces x f a :
      (a < q)%nat -> projected n Q2 (fun i => x i - image k A f i) a = projected n Q2 x a.
    Proof.
      intro ha. unfold projected at 1. rewrite dot_comm, dot_sub_l.
      rewrite (dot_comm n x), (dot_comm n (image k A f)).
      pose proof (projected_image f a ha) as none. unfold projected in *. rewrite none. ring.
    Qed.

    Lemma projection_of_normal e :
      normal_to n k A e -> norm2 q (projected n Q2 e) = norm2 n e.
    Proof.
      intro h. destruct (spans _ _ _ _ _ basis e h) as [c hc].
      assert (coordinate : forall a, (a < q)%nat -> projected n Q2 e a = c a).
      { intros a ha. unfold projected. rewrite dot_comm.
        unfold dot. rewrite (sum_ext n _ (fun i => image q Q2 c i * Q2 i a)).
        2: { intros i hi. now rewrite hc. }
        fold (dot n (image q Q2 c) (fun i => Q2 i a)). rewrite dot_image.
        rewrite (sum_ext q _ (fun l => if l =? a then c l else 0)).
        2: { intros l hl. rewrite (orthonormal _ _ _ _ _ basis) by assumption.
             destruct (l =? a); ring. }
        clear - ha. induction q as [| k' IH]; [lia | cbn [sum]].
        destruct (Nat.eq_dec a k') as [-> | no].
        - rewrite Nat.eqb_refl, (sum_ext _ _ (fun _ => 0)).
          + rewrite sum_zero. ring.
          + intros l hl. destruct (Nat.eqb_spec l k'); [lia | reflexivity].
        - rewrite IH by lia. destruct (Nat.eqb_spec k' a); [lia | ring]. }
      transitivity (norm2 q c).
      - unfold norm2, dot. apply sum_ext. intros a ha. now rewrite coordinate.
      - transitivity (dot n (image q Q2 c) e).
        + rewrite dot_image. unfold norm2, dot. apply sum_ext. intros a ha.
          rewrite <- coordinate at 2 by exact ha. reflexivity.
        + unfold norm2, dot. apply sum_ext. intros i hi. now rewrite hc.
    Qed.

    (** Claim C2. And nothing else is lost: || Q2^T x ||^2 is the least that forces leave of x. *)
    Theorem projection_is_elimination x :
      (exists f, norm2 q (projected n Q2 x) = norm2 n (fun i => x i - image k A f i)) /\
      forall f, norm2 q (projected n Q2 x) <= norm2 n (fun i => x i - image k A f i).
    Proof.
      destruct (best_force_exists n k A x) as [f hf].
      assert (e : norm2 q (projected n Q2 x) = norm2 n (fun i => x i - image k A f i)).
      { rewrite <- (projection_of_normal _ hf). unfold norm2, dot. apply sum_ext. intros a ha.
        now rewrite projection_removes_forces. }
      split; [now exists f |]. intro g. rewrite e. now apply normal_is_best.
    Qed.
  End OneSample.

  (** A window: N samples, each with rows, weights, contacts and projection of its own. The sample's
      residual x t is an affine function of the parameters; here any function of them. *)
  Section Window.
    Variables (Unknowns : Type) (N : nat).
    Variables (n k q : nat -> nat) (JT Q2 : nat -> nat -> nat -> K).
    (** W^(1/2), by rows: its square is the weight W. *)
    Variables (root : nat -> nat -> K).
    Variable residual : nat -> Unknowns -> nat -> K.

    Definition weighted (t : nat) (r : nat -> K) (i : nat) : K := root t i * r i.
    Definition weighted_JT (t i l : nat) : K := root t i * JT t i l.

    Hypothesis bases : forall t, (t < N)%nat ->
      contact_free (n t) (k t) (q t) (weighted_JT t) (Q2 t).

    (** (9): what is left of the weighted rows. *)
    Definition projected_objective (Phi : Unknowns) : K :=
      sum N (fun t => norm2 (q t) (projected (n t) (Q2 t) (weighted t (residual t Phi)))).

    (** sum over samples and rows of W (Y Phi - S^T tau - J^T f)^2, one f for each sample *)
    Definition augmented_objective (Phi : Unknowns) (f : nat -> nat -> K) : K :=
      sum N (fun t => sum (n t) (fun i =>
        let r := residual t Phi i - image (k t) (JT t) (f t) i in root t i * root t i * (r * r))).

    Lemma augmented_terms t Phi f :
      sum (n t) (fun i => let r := residual t Phi i - image (k t) (JT t) f i in
                          root t i * root t i * (r * r)) =
      norm2 (n t) (fun i => weighted t (residual t Phi) i - image (k t) (weighted_JT t) f i).
    Proof.
      unfold norm2, dot. apply sum_ext. intros i _. cbv zeta.
      assert (e : image (k t) (weighted_JT t) f i = root t i * image (k t) (JT t) f i).
      { unfold image, weighted_JT. rewrite <- sum_scale. apply sum_ext. intros. ring. }
      rewrite e. unfold weighted. ring.
    Qed.

    Lemma finite_choice M (P : nat -> (nat -> K) -> Prop) :
      (forall t, (t < M)%nat -> exists f, P t f) ->
      exists F, forall t, (t < M)%nat -> P t (F t).
    Proof.
      induction M as [| M IH]; intro h.
      - exists (fun _ _ => 0). intros t ht. lia.
      - destruct IH as [F hF]; [auto |]. destruct (h M) as [f hf]; [lia |].
        exists (fun t => if t =? M then f else F t). intros t ht.
        destruct (Nat.eqb_spec t M) as [-> | no]; [exact hf |]. apply hF. lia.
    Qed.

    (** Claim C2. For any parameters (9) is the least that contact forces can make of the weighted
        least squares in which they are unknowns. *)
    Theorem window_is_elimination Phi :
      (exists f : nat -> nat -> K, projected_objective Phi = augmented_objective Phi f) /\
      forall f : nat -> nat -> K, projected_objective Phi <= augmented_objective Phi f.
    Proof.
      split.
      - destruct (finite_choice N (fun t f =>
          norm2 (q t) (projected (n t) (Q2 t) (weighted t (residual t Phi))) =
          norm2 (n t) (fun i => weighted t (residual t Phi) i - image (k t) (weighted_JT t) f i)))
          as [f hf].
        + intros t ht. apply (projection_is_elimination _ _ _ _ _ (bases t ht)).
        + exists f. apply sum_ext. intros t ht. rewrite augmented_terms. now apply hf.
      - intro f. apply sum_le. intros t ht. rewrite augmented_terms.
        apply (projection_is_elimination _ _ _ _ _ (bases t ht)).
    Qed.

    (** Claim C2. So both problems have the same optimal parameters. *)
    Theorem same_optimal_parameters Phi :
      (forall Psi, projected_objective Phi <= projected_objective Psi) <->
      (exists f : nat -> nat -> K, forall Psi g,
         augmented_objective Phi f <= augmented_objective Psi g).
    Proof.
      split.
      - intro best. destruct (window_is_elimination Phi) as [[f e] _]. exists f. intros Psi g.
        rewrite <- e. apply (le_trans _ (projected_objective Psi)); [apply best |].
        apply window_is_elimination.
      - intros [f best] Psi. destruct (window_is_elimination Psi) as [[g e] _]. rewrite e.
        apply (le_trans _ (augmented_objective Phi f)); [apply window_is_elimination | apply best].
    Qed.
  End Window.
End Projection.
