(** Whether parameters can be made of the shapes, and what proves that they cannot. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem.

Section Cone.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m x s : nat -> K).

  Definition made_of_shapes p x : Prop :=
    exists m, nonnegative p m /\ forall k, (k < parameters p)%nat -> x k = Phi p m k.

  (** Claim C14. A direction in which the parameters are negative and no shape is separates them. *)
  Theorem separated_parameters_cannot_be_made p x s :
    (forall j, (j < shapes p)%nat -> 0 <= dot (parameters p) s (fun k => U p k j)) ->
    dot (parameters p) s x < 0 -> ~ made_of_shapes p x.
  Proof.
    intros no_shape [below no] [m [hm made]]. apply no. apply le_antisym; [exact below |].
    assert (e : dot (parameters p) s x =
                sum (shapes p) (fun j => m j * dot (parameters p) s (fun k => U p k j))).
    { unfold dot at 1.
      rewrite (sum_ext (parameters p) _
        (fun k => sum (shapes p) (fun j => m j * (s k * U p k j)))).
      - rewrite sum_swap. apply sum_ext. intros. apply sum_scale.
      - intros k hk. rewrite made by exact hk. unfold Phi. rewrite <- sum_scale.
        apply sum_ext. intros. ring. }
    rewrite e. apply sum_nonneg. intros j hj. apply mul_nonneg; [now apply hm | now apply no_shape].
  Qed.

  (** Claim C14. With s = U m - x at right angles to U m, as at the nearest point of the cone,
      s . x = - |s|^2: negative unless s is zero. If no shape is below s either, s separates
      (separated_parameters_cannot_be_made). *)
  Theorem nearest_point_decides p x m :
    let s k := Phi p m k - x k in
    dot (parameters p) s (Phi p m) = 0 ->
    dot (parameters p) s x = - norm2 (parameters p) s.
  Proof.
    intros s right_angle.
    assert (e : norm2 (parameters p) s =
                dot (parameters p) s (Phi p m) - dot (parameters p) s x).
    { unfold norm2, dot. rewrite <- sum_sub. apply sum_ext. intros. unfold s. ring. }
    rewrite e, right_angle. ring.
  Qed.
End Cone.
