(** Nonnegative masses give links that can exist. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field sums space mass_problem cuboid body.

Section Consistency.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Type Phi : Ten K.

  (** models/inertia.cpp, pseudo_inertia: integral of r r^T dm = tr(I)/2 - I. *)
  Definition second_moments Phi : Mat3 K := fun i j =>
    inv 2 * trace (tensor Phi) * identity i j - tensor Phi i j.

  (** (w, s)^T Sigma (w, s) *)
  Definition pseudo_inertia Phi (w : Vec3 K) (s : K) : K :=
    dot3 w (times (second_moments Phi) w) + 2 * s * dot3 w (first_moment Phi) + s * s * mass Phi.

  (** The pseudo-inertia is positive semidefinite. *)
  Definition consistent Phi : Prop := forall w s, 0 <= pseudo_inertia Phi w s.

  Local Ltac spread := unfold pseudo_inertia, second_moments, trace, tensor, first_moment, mass,
    times, dot3, sum3, identity; cbn.

  Lemma pseudo_inertia_linear a Phi1 b Phi2 w s :
    pseudo_inertia (fun k => a * Phi1 k + b * Phi2 k) w s =
    a * pseudo_inertia Phi1 w s + b * pseudo_inertia Phi2 w s.
  Proof. spread. ring. Qed.

  Lemma pseudo_inertia_ext Phi1 Phi2 w s :
    (forall k, Phi1 k = Phi2 k) -> pseudo_inertia Phi1 w s = pseudo_inertia Phi2 w s.
  Proof. intro e. spread. now rewrite !e. Qed.

  Lemma pseudo_inertia_sum n (u : nat -> Ten K) (m : nat -> K) w s :
    pseudo_inertia (fun k => sum n (fun j => u j k * m j)) w s =
    sum n (fun j => m j * pseudo_inertia (u j) w s).
  Proof.
    induction n as [| n IH]; cbn [sum].
    - spread. ring.
    - rewrite <- IH, (pseudo_inertia_ext _
        (fun k => 1 * sum n (fun j => u j k * m j) + m n * u n k)) by (intro; ring).
      rewrite pseudo_inertia_linear. ring.
  Qed.

  (** A unit mass at a point: (w . x + s)^2. *)
  Lemma point_form x w s :
    pseudo_inertia (point_parameters x) w s = (dot3 w x + s) * (dot3 w x + s).
  Proof.
    unfold point_parameters, steiner. spread. unfold identity, dot3, sum3; cbn.
    field. apply pos_nonzero, two_pos.
  Qed.

  (** Claim C7. A point mass can exist, *)
  Theorem points_are_consistent x : consistent (point_parameters x).
  Proof. intros w s. rewrite point_form. apply square_nonneg. Qed.

  (** A unit mass with centre c and covariance C: (w . c + s)^2 + w^T C w. *)
  Lemma solid_form (m : Moments K) w s :
    (forall i j, covariance m i j = covariance m j i) ->
    pseudo_inertia (unit_parameters m) w s =
    (dot3 w (centroid m) + s) * (dot3 w (centroid m) + s) + dot3 w (times (covariance m) w).
  Proof.
    intro sym. unfold unit_parameters, from_centre, steiner. destruct m as [v c C]. cbn in *.
    spread. unfold trace, identity, dot3, sum3; cbn.
    rewrite (sym ay ax), (sym az ax), (sym az ay). field. apply two_nonzero.
  Qed.

  Lemma twelve_pos : (0 : K) < 2 * 2 * 3.
  Proof.
    repeat apply mul_pos; try apply two_pos.
    apply add_pos; [apply one_pos | apply lt_le, two_pos].
  Qed.

  Lemma cuboid_form T c w s :
    pseudo_inertia (unit_parameters (moments_of T c)) w s =
    (dot3 w (centroid (moments_of T c)) + s) * (dot3 w (centroid (moments_of T c)) + s) +
    sum3 (fun a => let g := sum3 (fun i => w i * linear T i a) in
                   width c a * g * (width c a * g) / (2 * 2 * 3)).
  Proof.
    assert (cov : forall i j, covariance (moments_of T c) i j =
      sum3 (fun a => linear T i a * (width c a * width c a / (2 * 2 * 3)) * linear T j a)).
    { intros i j. cbn. unfold product, transposed, sum3. cbn. ring. }
    rewrite solid_form.
    2: { intros i j. rewrite !cov. unfold sum3. ring. }
    f_equal. unfold dot3 at 1, times. unfold sum3 at 1 2 3 4. rewrite !cov. unfold sum3.
    rewrite !div_mul. ring.
  Qed.

  (** Claim C7. ... so can every cuboid with whatever map, *)
  Theorem cuboids_are_consistent T c : consistent (unit_parameters (moments_of T c)).
  Proof.
    intros w s. rewrite cuboid_form. apply add_nonneg; [apply square_nonneg |]. unfold sum3 at 1.
    repeat apply add_nonneg; (apply div_nonneg; [apply square_nonneg | apply twelve_pos]).
  Qed.

  (** Claim C7. ... and every body of uniform density whatever its shape, *)
  Theorem bodies_are_consistent (B : Body K) : 0 < body_volume B -> consistent (body_parameters B).
  Proof.
    intros v w s.
    assert (form : pseudo_inertia (body_parameters B) w s =
                   pseudo_inertia (fun k => integral B (fun x => point_parameters x k)) w s /
                   body_volume B).
    { rewrite (pseudo_inertia_ext _ (fun k =>
        inv (body_volume B) * integral B (fun x => point_parameters x k) + 0 * 0)).
      - rewrite (pseudo_inertia_linear (inv (body_volume B))
          (fun k => integral B (fun x => point_parameters x k)) 0 (fun _ => 0)).
        rewrite div_mul. ring.
      - intro k. unfold body_parameters. rewrite div_mul. ring. }
    rewrite form. apply div_nonneg; [| exact v].
    (* The form is a combination of the ten numbers, so that it can be taken under the integral. *)
    pose (coefficient := fun k : nat => pseudo_inertia (fun l => if Nat.eqb l k then 1 else 0) w s).
    assert (combination : forall Phi,
      pseudo_inertia Phi w s = sum 10 (fun k => coefficient k * Phi k)).
    { intro Phi. unfold coefficient. spread. ring. }
    rewrite combination.
    destruct (integral_of_parameters B coefficient 10) as [hi he]. rewrite <- he.
    apply never_negative; [| exact hi].
    intro x. rewrite <- combination. apply points_are_consistent.
  Qed.

  (** Claim C7. ... and so every link of every answer: masses are not negative, shapes can exist. *)
  Theorem nonnegative_masses_are_consistent (p : MassProblem K) m link :
    (forall j, (j < shapes p)%nat -> consistent (fun k => U p (10 * link + k)%nat j)) ->
    nonnegative p m -> consistent (fun k => Phi p m (10 * link + k)%nat).
  Proof.
    intros hu hm w s. unfold mass_problem.Phi.
    rewrite (pseudo_inertia_sum (shapes p) (fun j k => U p (10 * link + k)%nat j) m).
    apply sum_nonneg. intros j hj. apply mul_nonneg; [now apply hm | now apply hu].
  Qed.

  (** Claim C7. A body that can exist has no negative mass, *)
  Theorem consistent_mass Phi : consistent Phi -> 0 <= mass Phi.
  Proof.
    intro h. specialize (h (fun _ => 0) 1). revert h. unfold pseudo_inertia, dot3, sum3.
    match goal with |- 0 <= ?a -> _ => replace a with (mass Phi) by ring end. auto.
  Qed.

  Lemma second_moments_nonneg Phi v : consistent Phi -> 0 <= dot3 v (times (second_moments Phi) v).
  Proof.
    intro h. specialize (h v 0). revert h. unfold pseudo_inertia.
    match goal with |- 0 <= ?a + ?b + ?c -> 0 <= ?a =>
      replace (a + b + c) with a by ring end. auto.
  Qed.

  (** v^T I v *)
  Definition moment_about Phi (v : Vec3 K) : K := dot3 v (times (tensor Phi) v).

  (** Two axes at right angles; the third is their cross product. *)
  Definition right_angles (e1 e2 : Vec3 K) : Prop :=
    dot3 e1 e1 = 1 /\ dot3 e2 e2 = 1 /\ dot3 e1 e2 = 0.

  Lemma axes_complete e1 e2 i j :
    right_angles e1 e2 ->
    e1 i * e1 j + e2 i * e2 j + cross e1 e2 i * cross e1 e2 j = identity i j.
  Proof.
    intros [h1 [h2 h3]].
    assert (lagrange : cross e1 e2 i * cross e1 e2 j =
      (dot3 e1 e1 * dot3 e2 e2 - dot3 e1 e2 * dot3 e1 e2) * identity i j -
      dot3 e2 e2 * (e1 i * e1 j) - dot3 e1 e1 * (e2 i * e2 j) +
      dot3 e1 e2 * (e1 i * e2 j + e2 i * e1 j)).
    { destruct i, j; unfold dot3, sum3, identity, cross; cbn; ring. }
    rewrite lagrange, h1, h2, h3. ring.
  Qed.

  (** tr I - v^T I v = 2 v^T (integral r r^T dm) v + ... for axes at right angles. *)
  Lemma other_axes Phi e1 e2 :
    right_angles e1 e2 ->
    moment_about Phi e1 + moment_about Phi e2 + moment_about Phi (cross e1 e2) =
    trace (tensor Phi).
  Proof.
    intro h.
    transitivity (sum3 (fun i => sum3 (fun j => tensor Phi i j *
      (e1 i * e1 j + e2 i * e2 j + cross e1 e2 i * cross e1 e2 j)))).
    { unfold moment_about, dot3, times, sum3. ring. }
    unfold sum3. rewrite !axes_complete by exact h. unfold trace, sum3, identity. cbn. ring.
  Qed.

  Lemma moment_and_second Phi v :
    2 * dot3 v (times (second_moments Phi) v) =
    trace (tensor Phi) * dot3 v v - 2 * moment_about Phi v.
  Proof.
    unfold second_moments, moment_about, dot3, times, sum3, identity. cbn.
    generalize (trace (tensor Phi)). intro t. field. apply two_nonzero.
  Qed.

  (** Claim C7. ... its tensor is positive semidefinite, *)
  Theorem consistent_tensor Phi v : consistent Phi -> 0 <= moment_about Phi v.
  Proof.
    intro h.
    pose (across := fun a => cross v (fun i => identity i a)).
    assert (form : moment_about Phi v =
      dot3 (across ax) (times (second_moments Phi) (across ax)) +
      dot3 (across ay) (times (second_moments Phi) (across ay)) +
      dot3 (across az) (times (second_moments Phi) (across az))).
    { unfold across, moment_about, second_moments, trace, tensor, dot3, times, sum3, cross,
        identity.
      cbn. field. apply two_nonzero. }
    rewrite form. apply add_nonneg; [apply add_nonneg |]; now apply second_moments_nonneg.
  Qed.

  (** Claim C7. ... and in any axes at right angles no moment exceeds the sum of the two others. *)
  Theorem consistent_triangle Phi e1 e2 :
    consistent Phi -> right_angles e1 e2 ->
    moment_about Phi e1 <= moment_about Phi e2 + moment_about Phi (cross e1 e2) /\
    moment_about Phi e2 <= moment_about Phi e1 + moment_about Phi (cross e1 e2) /\
    moment_about Phi (cross e1 e2) <= moment_about Phi e1 + moment_about Phi e2.
  Proof.
    intros h r. pose proof (other_axes Phi e1 e2 r) as t.
    assert (half : forall v, dot3 v v = 1 -> 0 <= trace (tensor Phi) - 2 * moment_about Phi v).
    { intros v one. replace (trace (tensor Phi)) with (trace (tensor Phi) * dot3 v v)
        by (rewrite one; ring).
      rewrite <- moment_and_second. apply mul_nonneg; [apply lt_le, two_pos |].
      now apply second_moments_nonneg. }
    assert (unit3 : dot3 (cross e1 e2) (cross e1 e2) = 1).
    { destruct r as [h1 [h2 h3]].
      transitivity (dot3 e1 e1 * dot3 e2 e2 - dot3 e1 e2 * dot3 e1 e2).
      - unfold dot3, cross, sum3. ring.
      - rewrite h1, h2, h3. ring. }
    pose proof (half e1 (proj1 r)) as t1. pose proof (half e2 (proj1 (proj2 r))) as t2.
    pose proof (half _ unit3) as t3. rewrite <- t in t1, t2, t3.
    split; [| split]; apply le_of_sub;
      [refine (eq_ind _ _ t1 _ _) | refine (eq_ind _ _ t2 _ _) | refine (eq_ind _ _ t3 _ _)]; ring.
  Qed.

  (** models/inertia.cpp, moved: Sigma' = T Sigma T^T, for any affine map. *)
  Definition moved (T : Frame K) Phi : Ten K :=
    parameters_of T (mass Phi) (first_moment Phi) (second_moments Phi).

  Lemma second_of_symmetric T v f (q : Mat3 K) i j :
    (forall a b, q a b = q b a) -> second_of T v f q i j = second_of T v f q j i.
  Proof.
    intro h. unfold second_of, sum3.
    rewrite (h ay ax), (h az ax), (h az ay). ring.
  Qed.

  Lemma second_moments_back v h (S : Mat3 K) i j :
    (forall a b, S a b = S b a) ->
    second_moments (from_origin v h (fun a b => trace S * identity a b - S a b)) i j = S i j.
  Proof.
    intro sym. unfold second_moments, trace, tensor, sum3, identity.
    destruct i, j; cbn; rewrite ?(sym ay ax), ?(sym az ax), ?(sym az ay);
      field; apply two_nonzero.
  Qed.

  (** Claim C7. Seen from any frame, about any point, a body that can exist can exist: the
      inequalities above hold about its centre of mass and in its principal axes too. *)
  Theorem consistent_in_every_frame T Phi : consistent Phi -> consistent (moved T Phi).
  Proof.
    intros h w s.
    specialize (h (times (transposed (linear T)) w) (dot3 w (translation T) + s)).
    refine (eq_ind _ _ h _ _). clear h.
    assert (sym : forall a b, second_moments Phi a b = second_moments Phi b a).
    { intros a b. unfold second_moments, tensor, identity. destruct a, b; reflexivity. }
    set (q := second_moments Phi) in *.
    assert (back : forall i j, second_moments (moved T Phi) i j =
                               second_of T (mass Phi) (first_moment Phi) q i j).
    { intros i j. apply second_moments_back. intros a b. now apply second_of_symmetric. }
    unfold pseudo_inertia. fold q. clearbody q.
    unfold times, dot3, sum3. rewrite !back. unfold moved, parameters_of, second_of, transposed.
    set (f := first_moment Phi).
    unfold first_moment, mass. cbn. fold (mass Phi). fold f. unfold times, sum3.
    generalize (mass Phi). intro v. clearbody f. ring.
  Qed.
End Consistency.
