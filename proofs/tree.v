(** All links: the generalised forces that a motion takes are Y Phi, with the columns of Y that
    reference/regressor.cpp makes of each link's block (equation (3)). *)
From Coq Require Import Ring Field Arith Lia List.
From Shapeid Require Import ordered_field sums space regressor.

Section Tree.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** A link at an instant: its particles and its motion in link axes, its axes R (link to base),
      and the velocities that each generalised direction gives its origin and its axes, in base
      axes. *)
  Record Link := {
    body : list (@Particle K);
    motion : @Motion K;
    axes : Mat3 K;
    origin_velocity : nat -> Vec3 K;
    angular_velocity : nat -> Vec3 K
  }.

  (** Row d of link l's ten columns: J^T [R 0; 0 R] B. *)
  Definition block (l : Link) (d k : nat) : K :=
    sum3 (fun i => origin_velocity l d i *
      sum3 (fun j => axes l i j * force_rows (motion l) j k)) +
    sum3 (fun i => angular_velocity l d i *
      sum3 (fun j => axes l i j * moment_rows (motion l) j k)).

  (** Y and Phi of all links, ten columns and ten numbers each. *)
  Definition regressor (links : nat -> Link) (d c : nat) : K :=
    block (links (c / 10)%nat) d (c mod 10)%nat.
  Definition parameters (links : nat -> Link) (c : nat) : K :=
    parameters_of_particles (body (links (c / 10)%nat)) (c mod 10)%nat.

  (** The velocity in link axes of the link's point x, if generalised direction d moves at one. *)
  Definition velocity (l : Link) (d : nat) (x : Vec3 K) : Vec3 K := fun i =>
    times (transposed (axes l)) (origin_velocity l d) i +
    cross (times (transposed (axes l)) (angular_velocity l d)) x i.

  (** d'Alembert: the power that the inertial forces of all particles have in direction d. *)
  Definition generalised_force (n : nat) (links : nat -> Link) (d : nat) : K :=
    sum n (fun l => total (fun '(mu, x) =>
      mu * dot3 (acceleration (motion (links l)) x) (velocity (links l) d x)) (body (links l))).

  Lemma block_is_virtual_power l d :
    sum 10 (fun k => block l d k * parameters_of_particles (body l) k) =
    total (fun '(mu, x) => mu * dot3 (acceleration (motion l) x) (velocity l d x)) (body l).
  Proof.
    unfold velocity. rewrite virtual_power. unfold dot3, sum3.
    rewrite !newton, !euler. unfold applied, times, transposed, sum3.
    set (P := parameters_of_particles (body l)).
    unfold block, sum3. cbn [sum]. ring.
  Qed.

  (** Claim C1. Y Phi of all links is the generalised force of all their particles. *)
  Theorem regressor_times_parameters n links d :
    sum (10 * n) (fun c => regressor links d c * parameters links c) = generalised_force n links d.
  Proof.
    rewrite sum_tens. apply sum_ext. intros l _. rewrite <- block_is_virtual_power.
    apply sum_ext. intros k hk. unfold regressor, parameters.
    replace ((10 * l + k) / 10)%nat with l.
    - replace ((10 * l + k) mod 10)%nat with k; [reflexivity |].
      rewrite Nat.add_comm, Nat.mul_comm, Nat.mod_add, Nat.mod_small by lia. reflexivity.
    - rewrite Nat.add_comm, Nat.mul_comm, Nat.div_add, Nat.div_small by lia. reflexivity.
  Qed.
End Tree.
