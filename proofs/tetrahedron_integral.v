(** The closed moments of models/polyhedron.cpp are Riemann integrals over each signed tetrahedron
    (o, a, b, c) with o at the origin: r = a x + b y + c z, for x, y, z >= 0 with x + y + z <= 1. *)
From Coq Require Import Reals Lra FunctionalExtensionality.
From Shapeid Require Import ordered_field numbers space integral cuboid.
Local Open Scope R_scope.

(** One coordinate after the other over the corner x, y, z >= 0, x + y + z <= 1. *)
Definition corner_integral (f : Vec3 reals -> R) (value : R) : Prop :=
  exists (over_z : R -> R -> R) (over_yz : R -> R),
    (forall x y, 0 <= x -> 0 <= y -> x + y <= 1 -> is_integral
      (fun z => f (fun i => match i with ax => x | ay => y | az => z end))
      0 (1 - x - y) (over_z x y)) /\
    (forall x, 0 <= x -> x <= 1 -> is_integral (fun y => over_z x y) 0 (1 - x) (over_yz x)) /\
    is_integral (fun x => over_yz x) 0 1 value.

(** The integral of every function of order at most two: 1 / 6, 1 / 24, 1 / 60 and 1 / 120. *)
Lemma corner_moments (c : reals) (g : Vec3 reals) (H : Mat3 reals) :
  corner_integral (quadratic c g H)
    (c / 6 + (g ax + g ay + g az) / 24 + (H ax ax + H ay ay + H az az) / 60 +
     (H ax ay + H ay ax + (H ax az + H az ax) + (H ay az + H az ay)) / 120).
Proof.
  unfold corner_integral, quadratic, sum3. cbn. by_name.
  generalize (g ax) (g ay) (g az). intros gx gy gz.
  generalize (H ax ay) (H ay ax) (H ax az) (H az ax) (H ay az) (H az ay).
  generalize (H ax ax) (H ay ay) (H az az). clear H.
  intros xx yy zz xy yx xz zx yz zy.
  (* Coefficients of z, then of y with u = 1 - x. *)
  set (a0 := fun x => c + gx * x + xx * (x * x)). set (a1 := fun x => gy + (xy + yx) * x).
  set (b0 := fun x => gz + (xz + zx) * x). set (b1 := yz + zy).
  exists (fun x y => let Z := 1 - x - y in
    (a0 x + a1 x * y + yy * (y * y)) * Z + (b0 x + b1 * y) * (Z * Z) / 2 + zz * (Z * Z * Z) / 3).
  exists (fun x => let u := 1 - x in
    (a0 x * u + b0 x * (u * u) / 2 + zz * (u * u * u) / 3) * u +
    (a1 x * u - a0 x + b1 * (u * u) / 2 - b0 x * u - zz * (u * u)) * (u * u) / 2 +
    (yy * u - a1 x + b0 x / 2 - b1 * u + zz * u) * (u * u * u) / 3 +
    (b1 / 2 - yy - zz / 3) * (u * u * u * u) / 4).
  split; [| split].
  - intros x y hx hy hxy. eapply is_integral_of with
      (c0 := a0 x + a1 x * y + yy * (y * y)) (c1 := b0 x + b1 * y) (c2 := zz) (c3 := 0) (c4 := 0);
      [lra | intro z; unfold a0, a1, b0, b1; ring | cbv zeta; field].
  - intros x hx hx1. eapply is_integral_of with
      (c0 := a0 x * (1 - x) + b0 x * ((1 - x) * (1 - x)) / 2 +
          zz * ((1 - x) * (1 - x) * (1 - x)) / 3)
      (c1 := a1 x * (1 - x) - a0 x + b1 * ((1 - x) * (1 - x)) / 2 - b0 x * (1 - x) -
             zz * ((1 - x) * (1 - x)))
      (c2 := yy * (1 - x) - a1 x + b0 x / 2 - b1 * (1 - x) + zz * (1 - x))
      (c3 := b1 / 2 - yy - zz / 3) (c4 := 0);
      [lra | intro y; cbv zeta; field | cbv zeta; field].
  - pose (X := xy + yx). pose (Y := xz + zx). pose (Z := yz + zy).
    eapply is_integral_of with
      (c0 := yy / 12 + Z / 24 + zz / 12 + c / 2 + gy / 6 + gz / 6)
      (c1 := X / 6 + Y / 6 - yy / 3 - Z / 6 - zz / 3 - c + gx / 2 - gy / 2 - gz / 2)
      (c2 := xx / 2 - X / 2 - Y / 2 + yy / 2 + Z / 4 + zz / 2 + c / 2 - gx + gy / 2 + gz / 2)
      (c3 := - xx + X / 2 + Y / 2 - yy / 3 - Z / 6 - zz / 3 + gx / 2 - gy / 6 - gz / 6)
      (c4 := xx / 2 - X / 6 - Y / 6 + yy / 12 + Z / 24 + zz / 12);
      [lra | intro x; unfold a0, a1, b0, b1, X, Y, Z; cbv zeta; field
           | unfold X, Y, Z, b1; field].
Qed.

Lemma corner_integral_of (c : reals) (g : Vec3 reals) (H : Mat3 reals) f value :
  (forall s, f s = quadratic c g H s) ->
  value = c / 6 + (g ax + g ay + g az) / 24 + (H ax ax + H ay ay + H az az) / 60 +
          (H ax ay + H ay ax + (H ax az + H az ax) + (H ay az + H az ay)) / 120 ->
  corner_integral f value.
Proof.
  intros same ->. replace f with (quadratic c g H); [apply corner_moments |].
  symmetry. apply functional_extensionality. exact same.
Qed.

Section Tetrahedron.
  Variables a b c : Vec3 reals.

  (** six_volumes of models/polyhedron.cpp: a . (b x c), the volume element. *)
  Definition six_volumes : R := dot3 a (cross b c).

  Definition point_at (s : Vec3 reals) (i : Axis) : R := a i * s ax + b i * s ay + c i * s az.

  Definition far_corners (i : Axis) : R := a i + b i + c i.

  (** Claim C6. The volume of a tetrahedron, *)
  Theorem tetrahedron_volume : corner_integral (fun _ => six_volumes) (six_volumes / 6).
  Proof.
    apply (corner_integral_of six_volumes (fun _ => 0) (fun _ _ => 0)).
    - intro s. unfold quadratic, sum3. by_name. ring.
    - field.
  Qed.

  (** Claim C6. ... its first moment, V g / 4 with g the sum of the corners, *)
  Theorem tetrahedron_first_moment i :
    corner_integral (fun s => six_volumes * point_at s i) (six_volumes / 6 * (far_corners i / 4)).
  Proof.
    apply (corner_integral_of 0
      (fun l => six_volumes * match l with ax => a i | ay => b i | az => c i end) (fun _ _ => 0)).
    - intro s. unfold quadratic, sum3, point_at. by_name. ring.
    - unfold far_corners. cbv beta iota. by_name. field.
  Qed.

  (** Claim C6. ... and its second moments, V / 20 (g g^T + a a^T + b b^T + c c^T). *)
  Theorem tetrahedron_second_moment i j :
    corner_integral (fun s => six_volumes * (point_at s i * point_at s j))
      (six_volumes / 6 / 20 *
       (far_corners i * far_corners j + a i * a j + b i * b j + c i * c j)).
  Proof.
    pose (corner := fun l k => match l with ax => a k | ay => b k | az => c k end).
    apply (corner_integral_of 0 (fun _ => 0)
      (fun l l' => six_volumes * (corner l i * corner l' j))).
    - intro s. unfold quadratic, sum3, point_at, corner. by_name. ring.
    - unfold far_corners, corner. cbv beta iota. by_name. field.
  Qed.
End Tetrahedron.
