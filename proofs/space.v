(** Vectors and matrices of space, and the ten inertial parameters in the order and with the signs
    of models/inertia.hpp: m, m rx, m ry, m rz, Ixx, Ixy, Ixz, Iyy, Iyz, Izz about the link origin,
    Ixy = - integral of x y dm. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field.

Inductive Axis := ax | ay | az.

Definition same_axis (i j : Axis) : bool :=
  match i, j with ax, ax | ay, ay | az, az => true | _, _ => false end.

Section Space.
  Context {K : OrderedField}.

  Definition Vec3 := Axis -> K.
  Definition Mat3 := Axis -> Axis -> K.

  Definition sum3 (f : Axis -> K) : K := f ax + f ay + f az.
  Definition dot3 (x y : Vec3) : K := sum3 (fun i => x i * y i).
  Definition times (A : Mat3) (x : Vec3) : Vec3 := fun i => sum3 (fun j => A i j * x j).
  Definition product (A B : Mat3) : Mat3 := fun i j => sum3 (fun k => A i k * B k j).
  Definition transposed (A : Mat3) : Mat3 := fun i j => A j i.
  Definition trace (A : Mat3) : K := sum3 (fun i => A i i).
  Definition identity : Mat3 := fun i j => if same_axis i j then 1 else 0.
  Definition determinant (A : Mat3) : K :=
    A ax ax * (A ay ay * A az az - A ay az * A az ay) -
    A ax ay * (A ay ax * A az az - A ay az * A az ax) +
    A ax az * (A ay ax * A az ay - A ay ay * A az ax).

  Definition cross (x y : Vec3) : Vec3 := fun i =>
    match i with
    | ax => x ay * y az - x az * y ay
    | ay => x az * y ax - x ax * y az
    | az => x ax * y ay - x ay * y ax
    end.

  (** S(v) w = v x w *)
  Definition skew (v : Vec3) : Mat3 := fun i j =>
    match i, j with
    | ax, ay => - v az | ax, az => v ay
    | ay, ax => v az | ay, az => - v ax
    | az, ax => - v ay | az, ay => v ax
    | _, _ => 0
    end.

  (** A body's ten parameters, or any other ten numbers in that order. *)
  Definition Ten := nat -> K.

  Definition from_origin (mass : K) (h : Vec3) (I : Mat3) : Ten := fun k =>
    match k with
    | 0 => mass
    | 1 => h ax | 2 => h ay | 3 => h az
    | 4 => I ax ax | 5 => I ax ay | 6 => I ax az | 7 => I ay ay | 8 => I ay az | 9 => I az az
    | _ => zero
    end%nat.

  Definition mass (Phi : Ten) : K := Phi 0%nat.
  Definition first_moment (Phi : Ten) : Vec3 := fun i =>
    Phi match i with ax => 1 | ay => 2 | az => 3 end%nat.
  Definition tensor (Phi : Ten) : Mat3 := fun i j =>
    Phi match i, j with
        | ax, ax => 4 | ax, ay => 5 | ax, az => 6
        | ay, ax => 5 | ay, ay => 7 | ay, az => 8
        | az, ax => 6 | az, ay => 8 | az, az => 9
        end%nat.

  (** |c|^2 1 - c c^T, times the mass the tensor about the origin of a point at c. *)
  Definition steiner (c : Vec3) : Mat3 := fun i j => dot3 c c * identity i j - c i * c j.

  (** The parameters of a unit mass at x. A body's are their integral over its mass. *)
  Definition point_parameters (x : Vec3) : Ten := from_origin 1 x (steiner x).

  Definition from_centre (m : K) (c : Vec3) (I : Mat3) : Ten :=
    from_origin m (fun i => m * c i) (fun i j => I i j + m * steiner c i j).
End Space.

Arguments Vec3 : clear implicits.
Arguments Mat3 : clear implicits.
Arguments Ten : clear implicits.
