(** The definitions as programs: evaluated over the rationals on the numbers that a test of the code
    gives (tests/proofs), so that what is proved here is about what is computed there. *)
From Coq Require Export List QArith Qcanon.
From Shapeid Require Export ordered_field numbers sums space mass_problem split cuboid consistency
  regressor certificate.
Export ListNotations.

(** A double is n / d with d a power of two. *)
Definition q (n : Z) (d : positive) : rationals := Q2Qc (n # d).

Definition vec (l : list rationals) (i : nat) : rationals := nth i l zero.
Definition mat (l : list (list rationals)) (i j : nat) : rationals := vec (nth i l nil) j.

Definition index_of (a : Axis) : nat := match a with ax => 0 | ay => 1 | az => 2 end.
Definition vec3 (l : list rationals) (a : Axis) : rationals := vec l (index_of a).
Definition mat3 (l : list (list rationals)) (a b : Axis) : rationals :=
  mat l (index_of a) (index_of b).

Definition entries (n : nat) (x : nat -> rationals) : list rationals := map x (seq 0 n).
Definition entries3 (x : Vec3 rationals) : list rationals := map x [ax; ay; az].
Definition entries33 (x : Mat3 rationals) : list rationals :=
  flat_map (fun a => entries3 (x a)) [ax; ay; az].

(** Numerators and denominators. *)
Definition fractions (l : list rationals) : list (Z * Z) :=
  map (fun x : Qc => (Qnum (this x), Zpos (Qden (this x)))) l.
