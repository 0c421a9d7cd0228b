(** The mass problem (15) as models/mass_problem.hpp states it:

      minimise over m >= 0:   f(m) = || W^(1/2) (Y U m - F) ||^2 + lambda sum_j m_j^2 / V_j

    with any number of rows, parameters and shapes. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field sums.

Record MassProblem (K : OrderedField) := {
  rows : nat;
  parameters : nat;
  shapes : nat;
  Y : nat -> nat -> K;
  F : nat -> K;
  W : nat -> K;
  U : nat -> nat -> K;
  V : nat -> K;
  lambda : K
}.

Arguments rows {K}.
Arguments parameters {K}.
Arguments shapes {K}.
Arguments Y {K}.
Arguments F {K}.
Arguments W {K}.
Arguments U {K}.
Arguments V {K}.
Arguments lambda {K}.

Section Objective.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m t : nat -> K).

  Definition well_formed p : Prop :=
    (forall i, (i < rows p)%nat -> 0 < W p i) /\
    (forall j, (j < shapes p)%nat -> 0 < V p j) /\ 0 <= lambda p.

  Definition nonnegative p m : Prop := forall j, (j < shapes p)%nat -> 0 <= m j.

  (** U m *)
  Definition Phi p m (k : nat) : K := sum (shapes p) (fun j => U p k j * m j).

  (** Y Phi - F, for any parameters Phi *)
  Definition residual p (x : nat -> K) (i : nat) : K :=
    sum (parameters p) (fun k => Y p i k * x k) - F p i.

  Definition data_of p (x : nat -> K) : K :=
    sum (rows p) (fun i => W p i * (residual p x i * residual p x i)).

  Definition data p m : K := data_of p (Phi p m).
  Definition density p m : K := lambda p * sum (shapes p) (fun j => m j * m j / V p j).
  Definition objective p m : K := data p m + density p m.

  (** The gradient of the data term with respect to the parameters, 2 Y^T W (Y Phi - F). *)
  Definition slope p (x : nat -> K) (k : nat) : K :=
    2 * sum (rows p) (fun i => Y p i k * (W p i * residual p x i)).

  (** z = grad f = 2 U^T Y^T W (Y U m - F) + 2 lambda m / V *)
  Definition gradient p m (j : nat) : K :=
    sum (parameters p) (fun k => U p k j * slope p (Phi p m) k) + 2 * lambda p * m j / V p j.

  Definition optimal p m : Prop :=
    nonnegative p m /\ forall t, nonnegative p t -> objective p m <= objective p t.

  (** || W^(1/2) Y d ||^2 *)
  Definition curvature p (d : nat -> K) : K :=
    sum (rows p) (fun i => let y := sum (parameters p) (fun k => Y p i k * d k) in W p i * (y * y)).

  Lemma curvature_nonneg p d : well_formed p -> 0 <= curvature p d.
  Proof.
    intros [w _]. apply sum_nonneg. intros i hi.
    apply mul_nonneg; [apply lt_le, w, hi | apply square_nonneg].
  Qed.

  (** The data term is a quadratic function of the parameters. *)
  Lemma data_expands p x y :
    data_of p y = data_of p x + sum (parameters p) (fun k => slope p x k * (y k - x k)) +
                  curvature p (fun k => y k - x k).
  Proof.
    unfold data_of, curvature, slope.
    assert (cross : sum (parameters p) (fun k =>
        2 * sum (rows p) (fun i => Y p i k * (W p i * residual p x i)) * (y k - x k)) =
      sum (rows p) (fun i => 2 * (W p i * residual p x i) *
        sum (parameters p) (fun k => Y p i k * (y k - x k)))).
    { rewrite (sum_ext _ _ (fun k => sum (rows p) (fun i =>
          2 * (y k - x k) * (Y p i k * (W p i * residual p x i))))).
      2: { intros k _. rewrite sum_scale. ring. }
      rewrite sum_swap. apply sum_ext. intros i _. rewrite <- sum_scale.
      apply sum_ext. intros k _. ring. }
    rewrite cross, <- !sum_add. apply sum_ext. intros i _. cbv zeta.
    assert (moved : residual p y i =
      residual p x i + sum (parameters p) (fun k => Y p i k * (y k - x k))).
    { unfold residual. rewrite (sum_ext _ (fun k => Y p i k * (y k - x k))
                            (fun k => Y p i k * y k - Y p i k * x k)) by (intros; ring).
      rewrite sum_sub. ring. }
    rewrite moved. ring.
  Qed.

  Lemma density_expands p m t :
    density p t = density p m + sum (shapes p) (fun j => 2 * lambda p * m j / V p j * (t j - m j)) +
                  lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j).
  Proof.
    unfold density. rewrite <- !sum_scale, <- !sum_add. apply sum_ext. intros j _.
    rewrite !div_mul. ring.
  Qed.

  (** f(t) from f(m), exactly: a slope z, and two terms that are never negative. *)
  Lemma objective_expands p m t :
    objective p t = objective p m + sum (shapes p) (fun j => gradient p m j * (t j - m j)) +
                    curvature p (fun k => Phi p t k - Phi p m k) +
                    lambda p * sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j).
  Proof.
    unfold objective, data. rewrite (data_expands p (Phi p m)), (density_expands p m t).
    assert (chain : sum (parameters p) (fun k => slope p (Phi p m) k * (Phi p t k - Phi p m k)) =
      sum (shapes p) (fun j =>
        sum (parameters p) (fun k => U p k j * slope p (Phi p m) k) * (t j - m j))).
    { rewrite (sum_ext _ _ (fun k => sum (shapes p) (fun j =>
          slope p (Phi p m) k * (U p k j * (t j - m j))))).
      2: { intros k _. rewrite sum_scale. f_equal. unfold Phi. rewrite <- sum_sub.
           apply sum_ext. intros. ring. }
      rewrite sum_swap. apply sum_ext. intros j _.
      rewrite (sum_ext _ _ (fun k => (t j - m j) * (U p k j * slope p (Phi p m) k)))
        by (intros; ring).
      rewrite sum_scale. ring. }
    assert (gradients : sum (shapes p) (fun j => gradient p m j * (t j - m j)) =
      sum (parameters p) (fun k => slope p (Phi p m) k * (Phi p t k - Phi p m k)) +
      sum (shapes p) (fun j => 2 * lambda p * m j / V p j * (t j - m j))).
    { rewrite chain, <- sum_add. apply sum_ext. intros j _. unfold gradient. ring. }
    rewrite gradients. ring.
  Qed.

  Lemma spread_nonneg p m t :
    well_formed p -> 0 <= sum (shapes p) (fun j => (t j - m j) * (t j - m j) / V p j).
  Proof.
    intros [_ [v _]]. apply sum_nonneg. intros j hj.
    apply div_nonneg; [apply square_nonneg | now apply v].
  Qed.
End Objective.
