(** The closed moments of cuboid.v are the integrals over the box: Riemann's, one coordinate after
    the other, of every function of order at most two. *)
From Coq Require Import Reals FunctionalExtensionality.
From Shapeid Require Import ordered_field numbers space integral cuboid.
Local Open Scope R_scope.

(** One coordinate after the other, the last one innermost. *)
Definition box_integral (f : Vec3 reals -> R) (c : Cell reals) (value : R) : Prop :=
  exists (over_z : R -> R -> R) (over_yz : R -> R),
    (forall x y, is_integral
      (fun z => f (fun i => match i with ax => x | ay => y | az => z end))
      (lower c az) (upper c az) (over_z x y)) /\
    (forall x, is_integral (fun y => over_z x y) (lower c ay) (upper c ay) (over_yz x)) /\
    is_integral (fun x => over_yz x) (lower c ax) (upper c ax) value.

(** Claim C6. The volume, centroid and covariance that the code computes of a cell of the canonical
    cuboid give the integral over the cell of every function of order at most two. *)
Theorem cuboid_moments_are_integrals c g H (cell : Cell reals) :
  (forall i, lower cell i <= upper cell i) ->
  box_integral (quadratic c g H) cell (integral_by_moments (canonical_moments cell) c g H).
Proof.
  intro ordered.
  destruct cell as [lo up]. cbn in ordered.
  unfold box_integral, quadratic, integral_by_moments, mean_product, sum3. cbn. unfold width. cbn.
  by_name.
  pose proof (ordered ax) as ox. pose proof (ordered ay) as oy. pose proof (ordered az) as oz.
  clear ordered.
  generalize dependent (lo ax). generalize dependent (lo ay). generalize dependent (lo az).
  generalize dependent (up ax). generalize dependent (up ay). generalize dependent (up az).
  clear lo up. cbn. intros bz by' bx az' oz ay' oy ax' ox.
  set (z1 := bz - az'). set (z2 := (bz * bz - az' * az') / 2).
  set (z3 := (bz * bz * bz - az' * az' * az') / 3).
  set (y1 := by' - ay'). set (y2 := (by' * by' - ay' * ay') / 2).
  set (y3 := (by' * by' * by' - ay' * ay' * ay') / 3).
  exists (fun x y =>
    (c + g ax * x + g ay * y + H ax ax * (x * x) + (H ax ay + H ay ax) * (x * y) +
     H ay ay * (y * y)) * z1 +
    (g az + (H ax az + H az ax) * x + (H ay az + H az ay) * y) * z2 + H az az * z3).
  exists (fun x =>
    ((c + g ax * x + H ax ax * (x * x)) * z1 + (g az + (H ax az + H az ax) * x) * z2 +
     H az az * z3) * y1 +
    ((g ay + (H ax ay + H ay ax) * x) * z1 + (H ay az + H az ay) * z2) * y2 +
    H ay ay * z1 * y3).
  split; [| split].
  - intros x y. eapply is_integral_of with
      (c0 := c + g ax * x + g ay * y + H ax ax * (x * x) + (H ax ay + H ay ax) * (x * y) +
             H ay ay * (y * y))
      (c1 := g az + (H ax az + H az ax) * x + (H ay az + H az ay) * y) (c2 := H az az)
      (c3 := 0) (c4 := 0);
      [exact oz | intro; ring | unfold z1, z2, z3; field].
  - intro x. eapply is_integral_of with
      (c0 := (c + g ax * x + H ax ax * (x * x)) * z1 + (g az + (H ax az + H az ax) * x) * z2 +
             H az az * z3)
      (c1 := (g ay + (H ax ay + H ay ax) * x) * z1 + (H ay az + H az ay) * z2)
      (c2 := H ay ay * z1) (c3 := 0) (c4 := 0);
      [exact oy | intro; ring | unfold y1, y2, y3; field].
  - eapply is_integral_of with
      (c0 := (c * z1 + g az * z2 + H az az * z3) * y1 +
             (g ay * z1 + (H ay az + H az ay) * z2) * y2 +
             H ay ay * z1 * y3)
      (c1 := (g ax * z1 + (H ax az + H az ax) * z2) * y1 + (H ax ay + H ay ax) * z1 * y2)
      (c2 := H ax ax * z1 * y1) (c3 := 0) (c4 := 0);
      [exact ox | intro; ring |].
    unfold y1, y2, y3, z1, z2, z3. by_name. field.
Qed.

(** Claim C6. So the ten unit parameters of a placed cuboid, times its volume, are the integrals of
    the ten parameters of a point, r = L s + t, with the volume element det L ds. *)
Theorem cuboid_parameters_are_integrals (T : Frame reals) (cell : Cell reals) k :
  (forall i, lower cell i <= upper cell i) ->
  let r (s : Vec3 reals) i := add (times (linear T) s i) (translation T i) in
  box_integral (fun s => determinant (linear T) * point_parameters (r s) k) cell
    (volume (moments_of T cell) * unit_parameters (moments_of T cell) k).
Proof.
  intros ordered r. set (d := determinant (linear T)).
  replace (fun s => d * point_parameters (r s) k) with
    (quadratic (d * constant_part T k) (fun a => d * linear_part T k a)
       (fun a b => d * quadratic_part T k a b)).
  - pose proof (parameters_by_moments T (canonical_moments cell) d k) as e.
    change (volume (moments_of T cell)) with (mul (volume (canonical_moments cell)) d).
    unfold moments_of. by_name. rewrite e. now apply cuboid_moments_are_integrals.
  - apply functional_extensionality. intro s. unfold r. rewrite point_parameters_expand.
    unfold quadratic, sum3. by_name. ring.
Qed.
