(** Newton and Euler for any finite set of particles: the wrench that a rigid motion takes is the
    6 x 10 block of reference/regressor.cpp (body_regressor) times the ten parameters. *)
From Coq Require Import Ring Field List.
From Shapeid Require Import ordered_field sums space.
Import ListNotations.

Section Regressor.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** A mass and where it is, in link axes from the link origin. *)
  Definition Particle := (K * Vec3 K)%type.

  Fixpoint total (f : Particle -> K) (body : list Particle) : K :=
    match body with
    | [] => 0
    | particle :: rest => f particle + total f rest
    end.

  (** The ten parameters of the particles: sum of mass times (1, x, tensor of a point). *)
  Definition parameters_of_particles (body : list Particle) : Ten K := fun k =>
    total (fun '(mu, x) => mu * point_parameters x k) body.

  (** How the link moves: angular velocity, angular acceleration, and the proper acceleration of the
      link origin, in link axes. *)
  Record Motion := { omega : Vec3 K; alpha : Vec3 K; origin : Vec3 K }.

  (** a + alpha x x + omega x (omega x x) *)
  Definition acceleration (q : Motion) (x : Vec3 K) : Vec3 K := fun i =>
    origin q i + cross (alpha q) x i + cross (omega q) (cross (omega q) x) i.

  (** Newton: the force is the sum of mass times acceleration. *)
  Definition force (q : Motion) (body : list Particle) : Vec3 K := fun i =>
    total (fun '(mu, x) => mu * acceleration q x i) body.

  (** Euler: the moment about the link origin is the sum of x x (mass times acceleration). *)
  Definition moment (q : Motion) (body : list Particle) : Vec3 K := fun i =>
    total (fun '(mu, x) => mu * cross x (acceleration q x) i) body.

  (** L(v) with I v = L(v) (Ixx, Ixy, Ixz, Iyy, Iyz, Izz) *)
  Definition tensor_times (v : Vec3 K) (i : Axis) (k : nat) : K :=
    match i, k with
    | ax, 0 => v ax | ax, 1 => v ay | ax, 2 => v az
    | ay, 1 => v ax | ay, 3 => v ay | ay, 4 => v az
    | az, 2 => v ax | az, 4 => v ay | az, 5 => v az
    | _, _ => zero
    end%nat.

  Definition axis_of (k : nat) : Axis := match k with 0 => ax | 1 => ay | _ => az end%nat.

  (** Upper rows: [ a, S(alpha) + S(omega) S(omega), 0 ] *)
  Definition force_rows (q : Motion) (i : Axis) (k : nat) : K :=
    match k with
    | 0%nat => origin q i
    | 1%nat | 2%nat | 3%nat => let j := axis_of (k - 1)%nat in
                   skew (alpha q) i j + product (skew (omega q)) (skew (omega q)) i j
    | _ => 0
    end.

  (** Lower rows: [ 0, -S(a), L(alpha) + S(omega) L(omega) ] *)
  Definition moment_rows (q : Motion) (i : Axis) (k : nat) : K :=
    match k with
    | 0%nat => 0
    | 1%nat | 2%nat | 3%nat => let j := axis_of (k - 1)%nat in - skew (origin q) i j
    | _ => let j := (k - 4)%nat in
           tensor_times (alpha q) i j +
           sum3 (fun l => skew (omega q) i l * tensor_times (omega q) l j)
    end.

  (** Ten columns times ten parameters. *)
  Definition applied (row : nat -> K) (Phi : Ten K) : K := sum 10 (fun k => row k * Phi k).

  Lemma applied_particles row body :
    applied row (parameters_of_particles body) =
    total (fun '(mu, x) => mu * applied row (point_parameters x)) body.
  Proof.
    unfold applied, parameters_of_particles. induction body as [| [mu x] rest IH].
    - cbn [total]. rewrite (sum_ext _ _ (fun _ => 0)); [apply sum_zero | intros; ring].
    - cbn [total]. rewrite <- IH, <- sum_scale, <- sum_add. apply sum_ext. intros. ring.
  Qed.

  Lemma total_ext f g body :
    (forall mu x, f (mu, x) = g (mu, x)) -> total f body = total g body.
  Proof. intro e. induction body as [| [mu x] rest IH]; cbn; [reflexivity | now rewrite e, IH]. Qed.

  (** Claim C1. The force on any finite set of particles is the regressor times Phi. *)
  Theorem newton q body i :
    force q body i = applied (force_rows q i) (parameters_of_particles body).
  Proof.
    rewrite applied_particles. apply total_ext. intros mu x. f_equal.
    unfold applied, acceleration. destruct i; cbn;
      unfold product, sum3, skew, steiner, dot3, identity, sum3; cbn; ring.
  Qed.

  (** Claim C1. The moment about the link origin likewise. *)
  Theorem euler q body i :
    moment q body i = applied (moment_rows q i) (parameters_of_particles body).
  Proof.
    rewrite applied_particles. apply total_ext. intros mu x. f_equal.
    unfold applied, acceleration. destruct i; cbn;
      unfold sum3, skew, steiner, dot3, identity, sum3, tensor_times; cbn; ring.
  Qed.

  (** Claim C1. Virtual power: whatever velocity v + w x x is given to the link, the particles'
      inertial forces have the power of that wrench. So a generalised direction that moves the link
      by (v, w) has the row v . force + w . moment, which is reference/regressor.cpp's J^T B. *)
  Theorem virtual_power q body v w :
    total (fun '(mu, x) => mu * dot3 (acceleration q x) (fun i => v i + cross w x i)) body =
    dot3 v (force q body) + dot3 w (moment q body).
  Proof.
    unfold force, moment. induction body as [| [mu x] rest IH]; cbn [total].
    - unfold dot3, sum3. ring.
    - rewrite IH. unfold dot3, sum3. cbn. ring.
  Qed.
End Regressor.
