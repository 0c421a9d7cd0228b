(** The moments of a cuboid as models/cuboid.cpp and models/shape.cpp compute them, and what becomes
    of them when it is cut across an axis. That they are the integrals over the box is in
    cuboid_integral.v. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field space.

Section Cuboid.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  Record Moments := { volume : K; centroid : Vec3 K; covariance : Mat3 K }.

  (** Bounds of the cell in canonical coordinates. *)
  Record Cell := { lower : Vec3 K; upper : Vec3 K }.

  (** An affine map r = L s + t. *)
  Record Frame := { linear : Mat3 K; translation : Vec3 K }.

  Definition width (c : Cell) (i : Axis) : K := upper c i - lower c i.

  Definition canonical_moments (c : Cell) : Moments := {|
    volume := width c ax * width c ay * width c az;
    centroid := fun i => inv 2 * (lower c i + upper c i);
    covariance := fun i j => if same_axis i j then width c i * width c i / (2 * 2 * 3) else 0
  |}.

  (** models/shape.cpp, moments_of: the canonical moments seen through the map. *)
  Definition placed (T : Frame) (m : Moments) : Moments := {|
    volume := volume m * determinant (linear T);
    centroid := fun i => times (linear T) (centroid m) i + translation T i;
    covariance := product (product (linear T) (covariance m)) (transposed (linear T))
  |}.

  Definition moments_of (T : Frame) (c : Cell) : Moments := placed T (canonical_moments c).

  (** Unit mass, uniform density. *)
  Definition unit_parameters (m : Moments) : Ten K :=
    from_centre 1 (centroid m)
      (fun i j => trace (covariance m) * identity i j - covariance m i j).

  (** A cuboid that can be: every width positive, and a map that does not turn it inside out. *)
  Definition solid (T : Frame) (c : Cell) : Prop :=
    (forall i, lower c i < upper c i) /\ 0 < determinant (linear T).

  (** models/shape.cpp, divide_across: the cut becomes a bound of either part. *)
  Definition with_value (x : Vec3 K) (axis : Axis) (s : K) : Vec3 K := fun i =>
    if same_axis i axis then s else x i.
  Definition below (c : Cell) (axis : Axis) (s : K) : Cell :=
    {| lower := lower c; upper := with_value (upper c) axis s |}.
  Definition above (c : Cell) (axis : Axis) (s : K) : Cell :=
    {| lower := with_value (lower c) axis s; upper := upper c |}.

  (** What a solid holds of a function of order at most two in canonical coordinates: its volume
      times the mean of 1, s_i, s_i s_j. *)
  Definition mean_product (m : Moments) (i j : Axis) : K :=
    covariance m i j + centroid m i * centroid m j.

  Lemma two_nonzero : (2 : K) <> 0.
  Proof. apply pos_nonzero, two_pos. Qed.
  Lemma three_nonzero : (3 : K) <> 0.
  Proof. apply pos_nonzero, add_pos; [apply one_pos | apply lt_le, two_pos]. Qed.

  Section OneCut.
    Variables (c : Cell) (axis : Axis) (s : K).
    Let m := canonical_moments c.
    Let m1 := canonical_moments (below c axis s).
    Let m2 := canonical_moments (above c axis s).

    Lemma canonical_volume : volume m = volume m1 + volume m2.
    Proof. destruct axis; cbn; unfold width; cbn; ring. Qed.

    Lemma canonical_first i :
      volume m * centroid m i = volume m1 * centroid m1 i + volume m2 * centroid m2 i.
    Proof.
      destruct axis, i; cbn; unfold width; cbn; field; apply two_nonzero.
    Qed.

    Lemma canonical_second i j :
      volume m * mean_product m i j =
      volume m1 * mean_product m1 i j + volume m2 * mean_product m2 i j.
    Proof.
      unfold mean_product. destruct axis, i, j; cbn; unfold width; cbn; field;
        repeat (apply conj || apply two_nonzero || apply three_nonzero || apply mul_nonzero).
    Qed.
  End OneCut.

  (** The parameters of the placed shape are linear in the canonical moments up to order two. *)
  Definition second_of (T : Frame) (v : K) (f : Vec3 K) (q : Mat3 K) (i j : Axis) : K :=
    sum3 (fun a => sum3 (fun b => linear T i a * linear T j b * q a b)) +
    times (linear T) f i * translation T j + translation T i * times (linear T) f j +
    v * translation T i * translation T j.

  Definition parameters_of (T : Frame) (v : K) (f : Vec3 K) (q : Mat3 K) : Ten K :=
    let S := second_of T v f q in
    from_origin v (fun i => times (linear T) f i + v * translation T i)
      (fun i j => trace S * identity i j - S i j).

  Lemma parameters_linear T m k :
    volume m * unit_parameters (placed T m) k =
    parameters_of T (volume m) (fun i => volume m * centroid m i)
      (fun i j => volume m * mean_product m i j) k.
  Proof.
    do 10 (destruct k as [| k]; [cbn; unfold mean_product, second_of, times, product, transposed,
      trace, dot3, sum3, steiner, identity; cbn; unfold dot3, sum3; ring |]).
    cbn. ring.
  Qed.

  Lemma parameters_of_add T v v1 v2 f f1 f2 q q1 q2 k :
    v = v1 + v2 -> (forall i, f i = f1 i + f2 i) -> (forall i j, q i j = q1 i j + q2 i j) ->
    parameters_of T v f q k = parameters_of T v1 f1 q1 k + parameters_of T v2 f2 q2 k.
  Proof.
    intros ev ef eq.
    assert (first : forall i, times (linear T) f i = times (linear T) f1 i + times (linear T) f2 i).
    { intro i. unfold times, sum3. rewrite !ef. ring. }
    assert (second : forall i j,
      second_of T v f q i j = second_of T v1 f1 q1 i j + second_of T v2 f2 q2 i j).
    { intros i j. unfold second_of. rewrite !first, ev. unfold sum3. rewrite !eq. ring. }
    unfold parameters_of.
    do 10 (destruct k as [| k]; [cbn; unfold trace, sum3; rewrite ?first, ?second, ?ev; ring |]).
    cbn. ring.
  Qed.

  (** Claim C4. A cuboid cut across any of its axes, wherever it is placed: the volumes add up, and
      the unit parameters by volume. *)
  Theorem cuboid_cut T c axis s :
    solid T c -> lower c axis < s -> s < upper c axis ->
    let whole := moments_of T c in
    let part1 := moments_of T (below c axis s) in
    let part2 := moments_of T (above c axis s) in
    volume whole = volume part1 + volume part2 /\ 0 < volume part1 /\ 0 < volume part2 /\
    forall k, volume whole * unit_parameters whole k =
              volume part1 * unit_parameters part1 k + volume part2 * unit_parameters part2 k.
  Proof.
    intros [hw hd] h1 h2. cbv zeta. unfold moments_of. cbn [placed volume].
    pose proof (canonical_volume c axis s) as ev.
    repeat split.
    - rewrite ev. ring.
    - apply mul_nonneg; [| now apply lt_le].
      destruct axis; cbn; unfold width; cbn;
        repeat apply mul_nonneg; apply sub_nonneg, lt_le; auto.
    - apply mul_pos; [| exact hd].
      destruct axis; cbn; unfold width; cbn;
        repeat apply mul_pos; apply (proj1 (lt_sub _ _)); auto.
    - apply mul_nonneg; [| now apply lt_le].
      destruct axis; cbn; unfold width; cbn;
        repeat apply mul_nonneg; apply sub_nonneg, lt_le; auto.
    - apply mul_pos; [| exact hd].
      destruct axis; cbn; unfold width; cbn;
        repeat apply mul_pos; apply (proj1 (lt_sub _ _)); auto.
    - intro k. set (d := determinant (linear T)).
      match goal with |- ?v * ?d * ?a = ?v1 * ?d * ?a1 + ?v2 * ?d * ?a2 =>
        cut (v * a = v1 * a1 + v2 * a2); [intro e;
          transitivity (d * (v * a)); [ring | rewrite e; ring] |] end.
      rewrite !parameters_linear. apply parameters_of_add.
      + exact ev.
      + intro i. apply canonical_first.
      + intros i j. apply canonical_second.
  Qed.

  (** Claim C4. models/cuboid.cpp, cut_coordinate: the lower part holds the asked share of the
      volume. *)
  Theorem cuboid_cut_coordinate T c axis share :
    let s := lower c axis + share * (upper c axis - lower c axis) in
    volume (moments_of T (below c axis s)) = share * volume (moments_of T c).
  Proof. destruct axis; cbn; unfold width; cbn; ring. Qed.

  (** A function of order at most two in the canonical coordinates, *)
  Definition quadratic (c : K) (g : Vec3 K) (H : Mat3 K) (s : Vec3 K) : K :=
    c + sum3 (fun a => g a * s a) + sum3 (fun a => sum3 (fun b => H a b * (s a * s b))).

  (** and its integral over the body as the moments give it. *)
  Definition integral_by_moments (m : Moments) (c : K) (g : Vec3 K) (H : Mat3 K) : K :=
    volume m * (c + sum3 (fun a => g a * centroid m a) +
                sum3 (fun a => sum3 (fun b => H a b * mean_product m a b))).

  (** The ten parameters of a point r = L s + t are such functions of s, with these coefficients. *)
  Definition constant_part T k := parameters_of T 1 (fun _ => 0) (fun _ _ => 0) k.
  Definition linear_part T k (a : Axis) :=
    parameters_of T 0 (fun i => identity i a) (fun _ _ => 0) k.
  Definition quadratic_part T k (a b : Axis) :=
    parameters_of T 0 (fun _ => 0) (fun i j => identity i a * identity j b) k.

  Lemma parameters_of_expands T v f q k :
    parameters_of T v f q k =
    constant_part T k * v + sum3 (fun a => linear_part T k a * f a) +
    sum3 (fun a => sum3 (fun b => quadratic_part T k a b * q a b)).
  Proof.
    pose (S := second_of T v f q).
    assert (second : forall i j, S i j =
      second_of T 1 (fun _ => 0) (fun _ _ => 0) i j * v +
      sum3 (fun a => second_of T 0 (fun l => identity l a) (fun _ _ => 0) i j * f a) +
      sum3 (fun a => sum3 (fun b =>
        second_of T 0 (fun _ => 0) (fun l l' => identity l a * identity l' b) i j * q a b))).
    { intros i j. unfold S, second_of, times, sum3, identity. cbn. ring. }
    unfold parameters_of at 1. fold S. clearbody S.
    unfold constant_part, linear_part, quadratic_part, parameters_of.
    destruct k as [| k]; [cbn; unfold sum3; ring |].
    do 3 (destruct k as [| k]; [cbn; unfold times, sum3, identity; cbn; ring |]).
    do 6 (destruct k as [| k]; [cbn; unfold trace, sum3; rewrite !second; unfold sum3; ring |]).
    cbn. unfold sum3. ring.
  Qed.

  Lemma point_parameters_expand T s k :
    point_parameters (fun i => times (linear T) s i + translation T i) k =
    quadratic (constant_part T k) (linear_part T k) (quadratic_part T k) s.
  Proof.
    transitivity (parameters_of T 1 s (fun a b => s a * s b) k).
    - do 10 (destruct k as [| k]; [cbn;
        unfold second_of, trace, steiner, dot3, times, sum3, identity;
        cbn; ring |]).
      cbn. ring.
    - rewrite parameters_of_expands. unfold quadratic. ring.
  Qed.

  Lemma parameters_by_moments T m d k :
    volume m * d * unit_parameters (placed T m) k =
    integral_by_moments m (d * constant_part T k) (fun a => d * linear_part T k a)
      (fun a b => d * quadratic_part T k a b).
  Proof.
    transitivity (d * (volume m * unit_parameters (placed T m) k)); [ring |].
    rewrite parameters_linear, parameters_of_expands. unfold integral_by_moments, sum3. ring.
  Qed.
End Cuboid.

Arguments Moments : clear implicits.
Arguments Cell : clear implicits.
Arguments Frame : clear implicits.
