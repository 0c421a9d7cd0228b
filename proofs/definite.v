(** A link is definite, not only semidefinite, once a cuboid has mass: a point or a rod is not. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums space mass_problem cuboid consistency.

Section Definite.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** (w, s)^T Sigma (w, s) = 0 for (w, s) = 0 alone. *)
  Definition definite (Phi : Ten K) : Prop :=
    consistent Phi /\ forall w s, pseudo_inertia Phi w s = 0 -> (forall i, w i = 0) /\ s = 0.

  (** Cramer's rule for L^T w = 0. *)
  Lemma only_zero (L : Mat3 K) w :
    determinant L <> 0 -> (forall a, sum3 (fun i => w i * L i a) = 0) -> forall i, w i = 0.
  Proof.
    intros det h i.
    pose proof (h ax) as hx. pose proof (h ay) as hy. pose proof (h az) as hz. clear h.
    destruct (mul_zero (determinant L) (w i)) as [no | yes]; [| contradiction | exact yes].
    destruct i.
    - transitivity (sum3 (fun i => w i * L i ax) * (L ay ay * L az az - L ay az * L az ay) +
                    sum3 (fun i => w i * L i ay) * (L ay az * L az ax - L ay ax * L az az) +
                    sum3 (fun i => w i * L i az) * (L ay ax * L az ay - L ay ay * L az ax)).
      + unfold determinant, sum3. ring.
      + rewrite hx, hy, hz. ring.
    - transitivity (sum3 (fun i => w i * L i ax) * (L az ay * L ax az - L az az * L ax ay) +
                    sum3 (fun i => w i * L i ay) * (L az az * L ax ax - L az ax * L ax az) +
                    sum3 (fun i => w i * L i az) * (L az ax * L ax ay - L az ay * L ax ax)).
      + unfold determinant, sum3. ring.
      + rewrite hx, hy, hz. ring.
    - transitivity (sum3 (fun i => w i * L i ax) * (L ax ay * L ay az - L ax az * L ay ay) +
                    sum3 (fun i => w i * L i ay) * (L ax az * L ay ax - L ax ax * L ay az) +
                    sum3 (fun i => w i * L i az) * (L ax ax * L ay ay - L ax ay * L ay ax)).
      + unfold determinant, sum3. ring.
      + rewrite hx, hy, hz. ring.
  Qed.

  (** Claim C7. A cuboid is definite. *)
  Theorem cuboids_are_definite T c : solid T c -> definite (unit_parameters (moments_of T c)).
  Proof.
    intros [hw hd]. split; [apply cuboids_are_consistent |]. intros w s.
    rewrite cuboid_form. intro zero.
    set (g := fun a => sum3 (fun i => w i * linear T i a)) in *.
    assert (term : forall a, 0 <= width c a * g a * (width c a * g a) / (2 * 2 * 3)).
    { intro a. apply div_nonneg; [apply square_nonneg | apply twelve_pos]. }
    assert (each : forall a, width c a * g a * (width c a * g a) / (2 * 2 * 3) = 0 -> g a = 0).
    { intros a e. rewrite div_mul in e. destruct (mul_zero _ _ e) as [e' | e'].
      - apply square_zero in e'. destruct (mul_zero _ _ e') as [e'' | e'']; [| exact e''].
        destruct (hw a) as [_ no]. destruct no.
        replace (upper c a) with (width c a + lower c a) by (unfold width; ring). rewrite e''. ring.
      - destruct (inv_nonzero (2 * 2 * 3 : K)); [apply pos_nonzero, twelve_pos | exact e']. }
    set (from_plane := dot3 w (centroid (moments_of T c)) + s) in *.
    set (square := from_plane * from_plane) in *.
    assert (square_nn : 0 <= square) by apply square_nonneg.
    assert (square0 : square = 0).
    { apply (add_zero _ _ square_nn) in zero; [exact zero |].
      apply add_nonneg; [apply add_nonneg |]; apply term. }
    rewrite square0 in zero.
    assert (g0 : forall a, g a = 0).
    { assert (three : forall x y z : K, 0 <= x -> 0 <= y -> 0 <= z -> 0 + (x + y + z) = 0 ->
                      x = 0 /\ y = 0 /\ z = 0).
      { intros x y z hx hy hz e.
        split; [| split].
        - apply (add_zero x (y + z)); [exact hx | now apply add_nonneg |]. rewrite <- e. ring.
        - apply (add_zero y (x + z)); [exact hy | now apply add_nonneg |]. rewrite <- e. ring.
        - apply (add_zero z (x + y)); [exact hz | now apply add_nonneg |]. rewrite <- e. ring. }
      destruct (three _ _ _ (term ax) (term ay) (term az) zero) as [x0 [y0 z0]].
      intros []; now apply each. }
    assert (w0 : forall i, w i = 0).
    { apply (only_zero (linear T)); [now apply pos_nonzero | exact g0]. }
    split; [exact w0 |].
    apply square_zero in square0. rewrite <- square0. unfold from_plane, dot3, sum3. rewrite !w0.
    ring.
  Qed.

  (** Claim C7. So is a link that a definite shape with mass belongs to, whatever the others are. *)
  Theorem mass_makes_definite (p : MassProblem K) m link j :
    (forall i, (i < shapes p)%nat -> consistent (fun k => U p (10 * link + k)%nat i)) ->
    nonnegative p m -> (j < shapes p)%nat -> 0 < m j ->
    definite (fun k => U p (10 * link + k)%nat j) ->
    definite (fun k => Phi p m (10 * link + k)%nat).
  Proof.
    intros hu hm hj some [_ one]. split; [now apply nonnegative_masses_are_consistent |].
    intros w s zero. apply one.
    unfold Phi in zero.
    rewrite (pseudo_inertia_sum (shapes p) (fun i k => U p (10 * link + k)%nat i) m) in zero.
    assert (term : m j * pseudo_inertia (fun k => U p (10 * link + k)%nat j) w s = 0).
    { apply (sum_nonneg_zero (shapes p)
        (fun i => m i * pseudo_inertia (fun k => U p (10 * link + k)%nat i) w s)); try assumption.
      intros i hi. apply mul_nonneg; [now apply hm | now apply hu]. }
    destruct (mul_zero _ _ term) as [none | done]; [| exact done].
    now destruct (pos_nonzero _ some).
  Qed.
End Definite.
