(** Any body of uniform density: all that is used of it is that integrals over it are linear and
    never negative for functions that are not. Cut by a plane, or by anything else, it gives two
    bodies, and moments add up because integrals do. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field sums space.

Section Body.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).

  (** Functions that can be integrated over the body, and their integrals over its volume. *)
  Record Body := {
    integrable : (Vec3 K -> K) -> Prop;
    integral : (Vec3 K -> K) -> K;
    same_integral : forall f g, (forall x, f x = g x) -> integrable f ->
      integrable g /\ integral g = integral f;
    integral_linear : forall a b f g, integrable f -> integrable g ->
      integrable (fun x => a * f x + b * g x) /\
      integral (fun x => a * f x + b * g x) = a * integral f + b * integral g;
    never_negative : forall f, (forall x, 0 <= f x) -> integrable f -> 0 <= integral f;
    has_moments : integrable (fun _ => 1) /\ (forall i, integrable (fun x => x i)) /\
      (forall i j, integrable (fun x => x i * x j))
  }.

  Definition body_volume (B : Body) : K := integral B (fun _ => 1).

  (** Mean over the volume of what a unit mass at x has: the ten parameters of the body at unit mass
      and uniform density. *)
  Definition body_parameters (B : Body) : Ten K := fun k =>
    integral B (fun x => point_parameters x k) / body_volume B.

  (** [B1] and [B2] are what a function [side] (1 on one side, 0 on the other) leaves of [B]. What
      can be integrated over one can be over the others. *)
  Definition cut_by (side : Vec3 K -> K) (B B1 B2 : Body) : Prop :=
    (forall x, side x = 0 \/ side x = 1) /\
    (forall f, (integrable B1 f <-> integrable B f) /\ (integrable B2 f <-> integrable B f)) /\
    (forall f, integrable B f -> integrable B (fun x => side x * f x)) /\
    (forall f, integrable B f -> integral B1 f = integral B (fun x => side x * f x)) /\
    (forall f, integrable B f -> integral B2 f = integral B (fun x => (1 - side x) * f x)).

  Lemma parts_add_up side B B1 B2 f :
    cut_by side B B1 B2 -> integrable B f -> integral B f = integral B1 f + integral B2 f.
  Proof.
    intros [_ [_ [stays [i1 i2]]]] hf. rewrite (i1 f hf), (i2 f hf).
    pose proof (stays f hf) as hs.
    destruct (integral_linear B 1 (- (1)) f (fun x => side x * f x) hf hs) as [h e].
    assert (rest : forall x, 1 * f x + - (1) * (side x * f x) = (1 - side x) * f x)
      by (intro; ring).
    destruct (same_integral B _ _ rest h) as [_ ->]. rewrite e. ring.
  Qed.

  (** The parameters of a point are of order at most two, and are integrable. *)
  Lemma integrable_sum B f g :
    integrable B f -> integrable B g -> integrable B (fun x => f x + g x).
  Proof.
    intros hf hg. destruct (integral_linear B 1 1 f g hf hg) as [h _].
    refine (proj1 (same_integral B _ _ _ h)). intros. ring.
  Qed.

  Lemma integrable_scaled B a f : integrable B f -> integrable B (fun x => a * f x).
  Proof.
    intros hf. destruct (integral_linear B a 0 f f hf hf) as [h _].
    refine (proj1 (same_integral B _ _ _ h)). intros. ring.
  Qed.

  Lemma parameters_integrable B k : integrable B (fun x => point_parameters x k).
  Proof.
    destruct (has_moments B) as [h0 [h1 h2]].
    assert (square : forall i j, integrable B (fun x : Vec3 K => x i * x i + x j * x j)).
    { intros i j. now apply integrable_sum. }
    assert (minus : forall i j, integrable B (fun x : Vec3 K => - (1) * (x i * x j))).
    { intros i j. now apply integrable_scaled. }
    do 10 (destruct k as [| k];
      [cbn; first [exact h0 | apply h1
        | refine (proj1 (same_integral B _ _ _ (square ay az)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring
        | refine (proj1 (same_integral B _ _ _ (square ax az)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring
        | refine (proj1 (same_integral B _ _ _ (square ax ay)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring
        | refine (proj1 (same_integral B _ _ _ (minus ax ay)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring
        | refine (proj1 (same_integral B _ _ _ (minus ax az)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring
        | refine (proj1 (same_integral B _ _ _ (minus ay az)));
          intro; unfold steiner, dot3, sum3, identity; cbn; ring] |]).
    cbn. refine (proj1 (same_integral B _ _ _ (integrable_scaled B 0 _ h0))). intro. ring.
  Qed.

  (** A combination of a point's parameters is integrated number by number. *)
  Lemma integral_of_parameters B (c : nat -> K) n :
    integrable B (fun x => sum n (fun k => c k * point_parameters x k)) /\
    integral B (fun x => sum n (fun k => c k * point_parameters x k)) =
    sum n (fun k => c k * integral B (fun x => point_parameters x k)).
  Proof.
    induction n as [| n [IHi IHe]]; cbn [sum].
    - destruct (has_moments B) as [h0 _].
      destruct (integral_linear B 0 0 _ _ h0 h0) as [h e].
      assert (nothing : forall _ : Vec3 K, 0 * 1 + 0 * 1 = (0 : K)) by (intro; ring).
      destruct (same_integral B _ _ nothing h) as [h' e'].
      split; [exact h' |]. rewrite e', e. ring.
    - destruct (integral_linear B 1 (c n) _ _ IHi (parameters_integrable B n)) as [h e].
      assert (one_more : forall x,
        1 * sum n (fun k => c k * point_parameters x k) + c n * point_parameters x n =
        sum n (fun k => c k * point_parameters x k) + c n * point_parameters x n)
        by (intro; ring).
      destruct (same_integral B _ _ one_more h) as [h' e'].
      split; [exact h' |]. rewrite e', e, IHe. ring.
  Qed.

  (** Claim C4. Every moment up to order two is what the parts hold together. *)
  Theorem moments_add_up side B B1 B2 :
    cut_by side B B1 B2 ->
    body_volume B = body_volume B1 + body_volume B2 /\
    (forall i, integral B (fun x => x i) =
               integral B1 (fun x => x i) + integral B2 (fun x => x i)) /\
    (forall i j, integral B (fun x => x i * x j) =
                 integral B1 (fun x => x i * x j) + integral B2 (fun x => x i * x j)).
  Proof.
    intro c. destruct (has_moments B) as [h0 [h1 h2]].
    split; [| split]; intros; now apply (parts_add_up side).
  Qed.

  (** Claim C4. Any body cut by a plane, or by anything else: the unit parameters add up by volume.
      With split.v, a cut at equal density then changes nothing. *)
  Theorem body_cut side B B1 B2 k :
    cut_by side B B1 B2 -> 0 < body_volume B1 -> 0 < body_volume B2 ->
    body_volume B * body_parameters B k =
    body_volume B1 * body_parameters B1 k + body_volume B2 * body_parameters B2 k.
  Proof.
    intros c v1 v2. destruct (moments_add_up side B B1 B2 c) as [ev _].
    assert (v : 0 < body_volume B) by (rewrite ev; apply add_pos; [| apply lt_le]; assumption).
    unfold body_parameters.
    rewrite (parts_add_up side B B1 B2 _ c (parameters_integrable B k)).
    field. repeat apply conj; now apply pos_nonzero.
  Qed.

  (** A body lies in a region if what is at least [low] there has a mean of at least [low]. *)
  Definition lies_in (region : Vec3 K -> Prop) (B : Body) : Prop :=
    forall f low, integrable B f -> (forall x, region x -> low <= f x) ->
    low * body_volume B <= integral B f.

  Lemma below_lies_in region side B B1 B2 :
    cut_by side B B1 B2 -> lies_in region B -> lies_in region B1.
  Proof.
    intros [sides [both [stays [i1 _]]]] inside f low h1 bound.
    pose proof (proj1 (proj1 (both f)) h1) as hf.
    pose proof (stays f hf) as hs. destruct (has_moments B) as [h0 _].
    pose proof (stays _ h0) as hs0.
    destruct (integral_linear B 1 (- low) _ _ hs hs0) as [h e].
    apply le_of_sub. unfold body_volume. rewrite (i1 f hf), (i1 _ h0).
    match goal with |- 0 <= ?a - low * ?b => replace (a - low * b)
        with (1 * a + - low * b) by ring end.
    rewrite <- e. replace 0 with (0 * body_volume B) by ring.
    apply inside; [exact h |]. intros x hx. destruct (sides x) as [-> | ->].
    - match goal with |- 0 <= ?a => replace a with (0 : K) by ring end. apply le_refl.
    - match goal with |- 0 <= ?a => replace a with (f x - low) by ring end.
      now apply sub_nonneg, bound.
  Qed.

  Lemma above_lies_in region side B B1 B2 :
    cut_by side B B1 B2 -> lies_in region B -> lies_in region B2.
  Proof.
    intros [sides [both [stays [i1 i2]]]].
    apply (below_lies_in region (fun x => 1 - side x) B B2 B1).
    assert (other : forall f, integrable B f -> integrable B (fun x => (1 - side x) * f x)).
    { intros f hf. destruct (integral_linear B 1 (- (1)) f _ hf (stays f hf)) as [h _].
      refine (proj1 (same_integral B _ _ _ h)). intro. ring. }
    split; [| split; [| split; [| split]]].
    - intro x. destruct (sides x) as [-> | ->]; [right | left]; ring.
    - intro f. destruct (both f). now split.
    - exact other.
    - exact i2.
    - intros f hf. rewrite (i1 f hf).
      refine (proj2 (same_integral B _ _ _ _)); [intro; ring |].
      destruct (integral_linear B 1 (- (1)) f _ hf (other f hf)) as [h _].
      refine (proj1 (same_integral B _ _ _ h)). intro. ring.
  Qed.
  (** Claim C15. Parts of a body lie where it lies: no division leaves the regions. *)
  Theorem parts_stay_in_the_region region side B B1 B2 :
    cut_by side B B1 B2 -> lies_in region B -> lies_in region B1 /\ lies_in region B2.
  Proof.
    intros c inside. split.
    - exact (below_lies_in region side B B1 B2 c inside).
    - exact (above_lies_in region side B B1 B2 c inside).
  Qed.
End Body.

Arguments Body : clear implicits.
