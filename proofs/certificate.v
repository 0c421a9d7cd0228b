(** The bound of a certificate in terms of the gradient z: how far any masses are from the optimum,
    from their gradient alone. The checker evaluates the equivalent form (B) of
    docs/derivations/certificate.md, which duality.v models. The bound [M] of the total mass
    belongs to the problem.

      f(m) - f* <= - min over { t >= 0, sum t <= M } of
                     sum_j [ z_j (t_j - m_j) + lambda (t_j - m_j)^2 / V_j ] *)
From Coq Require Import Ring Field Lia.
From Shapeid Require Import ordered_field sums mass_problem.

Section Certificate.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (m t : nat -> K) (M mu : K).

  (** The masses among which the optimum is sought. *)
  Definition within p M t : Prop := nonnegative p t /\ sum (shapes p) t <= M.

  (** What the certificate minimises: a lower model of f(t) - f(m). *)
  Definition model p m t : K :=
    sum (shapes p) (fun j =>
      gradient p m j * (t j - m j) + lambda p * ((t j - m j) * (t j - m j) / V p j)).

  Lemma model_below p m t : well_formed p -> objective p m + model p m t <= objective p t.
  Proof.
    intro wf. apply le_sub. rewrite (objective_expands p m t). unfold model.
    rewrite sum_add, sum_scale.
    match goal with |- 0 <= ?a + ?b + ?c + ?d - (?a + (?b + ?d)) =>
      replace (a + b + c + d - (a + (b + d))) with c by ring end.
    now apply curvature_nonneg.
  Qed.

  (** Claim C14. Whatever bounds the model from below bounds the optimum, for any m. *)
  Theorem certificate_bounds_the_optimum p M m low :
    well_formed p -> (forall t, within p M t -> low <= model p m t) ->
    forall t, within p M t -> objective p m + low <= objective p t.
  Proof.
    intros wf bound t ht. apply (le_trans _ (objective p m + model p m t)).
    - apply le_add; [apply le_refl | now apply bound].
    - now apply model_below.
  Qed.

  (** The minimum is taken jointly: one multiplier [mu] for the sum of masses. For each shape the
      minimum over t_j >= 0 of (z_j + mu) (t_j - m_j) + lambda (t_j - m_j)^2 / V_j lies at *)
  Definition step p m mu (j : nat) : K := (gradient p m j + mu) * V p j / (2 * lambda p).

  (** ... the larger of zero and m_j - step. *)
  Definition minimiser p m mu (j : nat) (s : K) : Prop :=
    (step p m mu j <= m j /\ s = m j - step p m mu j) \/ (m j <= step p m mu j /\ s = 0).

  Definition term p m mu (j : nat) (s : K) : K :=
    (gradient p m j + mu) * (s - m j) + lambda p * ((s - m j) * (s - m j) / V p j).

  Lemma minimiser_nonneg p m mu j s : minimiser p m mu j s -> 0 <= s.
  Proof.
    intros [[h ->] | [_ ->]]; [now apply sub_nonneg | apply le_refl].
  Qed.

  (** There is one for every shape. *)
  Lemma minimiser_exists p m mu j : exists s, minimiser p m mu j s.
  Proof.
    destruct (le_total (step p m mu j) (m j)); [exists (m j - step p m mu j) | exists 0];
      [left | right]; now split.
  Qed.

  Lemma minimiser_minimises p m mu j s :
    well_formed p -> 0 < lambda p -> (j < shapes p)%nat -> minimiser p m mu j s ->
    forall r, 0 <= r -> term p m mu j s <= term p m mu j r.
  Proof.
    intros wf l hj hs r hr.
    assert (v : 0 < V p j) by now apply wf.
    pose proof (pos_nonzero _ v) as nv. pose proof (pos_nonzero _ l) as nl.
    pose proof (pos_nonzero _ two_pos : (2 : K) <> 0) as n2.
    apply le_sub.
    assert (form : term p m mu j r - term p m mu j s =
      lambda p * ((r - s) * (r - s) / V p j) +
      2 * (lambda p / V p j * ((s - (m j - step p m mu j)) * (r - s)))).
    { unfold term, step. field. auto. }
    rewrite form. apply add_nonneg.
    - apply mul_nonneg; [now apply lt_le |]. apply div_nonneg; [apply square_nonneg | exact v].
    - apply mul_nonneg; [apply lt_le, two_pos |].
      apply mul_nonneg; [apply div_nonneg; [now apply lt_le | exact v] |].
      destruct hs as [[h ->] | [h ->]].
      + replace ((m j - step p m mu j - (m j - step p m mu j)) * (r - (m j - step p m mu j)))
          with (0 : K) by ring. apply le_refl.
      + apply mul_nonneg.
        * replace (0 - (m j - step p m mu j)) with (step p m mu j - m j) by ring.
          now apply sub_nonneg.
        * replace (r - 0) with r by ring. exact hr.
  Qed.

  (** With any multiplier mu >= 0, a bound. *)
  Definition bound p M m mu (s : nat -> K) : K :=
    sum (shapes p) (fun j => term p m mu j (s j)) + mu * (sum (shapes p) m - M).

  Lemma model_and_terms p M m mu t :
    model p m t = bound p M m mu t + mu * (M - sum (shapes p) t).
  Proof.
    unfold bound, model, term.
    rewrite (sum_ext _ (fun j => (gradient p m j + mu) * (t j - m j) + _)
      (fun j => gradient p m j * (t j - m j) + lambda p * ((t j - m j) * (t j - m j) / V p j) +
                mu * (t j - m j))) by (intros; ring).
    rewrite (sum_add _ (fun j => gradient p m j * (t j - m j) +
                                 lambda p * ((t j - m j) * (t j - m j) / V p j))).
    rewrite sum_scale, (sum_sub _ t m). ring.
  Qed.

  Lemma bound_below_model p M m mu s :
    well_formed p -> 0 < lambda p -> 0 <= mu ->
    (forall j, (j < shapes p)%nat -> minimiser p m mu j (s j)) ->
    forall t, within p M t -> bound p M m mu s <= model p m t.
  Proof.
    intros wf l hmu hs t [ht total]. rewrite (model_and_terms p M m mu t).
    replace (bound p M m mu s) with (bound p M m mu s + 0) by ring. apply le_add.
    - apply le_add; [| apply le_refl]. apply sum_le. intros j hj.
      apply minimiser_minimises; auto.
    - apply mul_nonneg; [exact hmu | now apply sub_nonneg].
  Qed.

  (** Claim C14. The bound with a multiplier is one, whichever mu >= 0 was chosen. *)
  Theorem multiplier_bounds_the_optimum p M m mu s :
    well_formed p -> 0 < lambda p -> 0 <= mu ->
    (forall j, (j < shapes p)%nat -> minimiser p m mu j (s j)) ->
    forall t, within p M t -> objective p m + bound p M m mu s <= objective p t.
  Proof.
    intros wf l hmu hs. apply certificate_bounds_the_optimum; [exact wf |].
    now apply bound_below_model.
  Qed.

  (** Claim C14. Nothing is given away where the multiplier fits, being zero or the masses using up
      M: then the bound is the joint minimum itself. *)
  Theorem fitting_multiplier_is_the_minimum p M m mu s :
    well_formed p -> 0 < lambda p -> 0 <= mu ->
    (forall j, (j < shapes p)%nat -> minimiser p m mu j (s j)) ->
    sum (shapes p) s <= M -> mu * (M - sum (shapes p) s) = 0 ->
    within p M s /\ bound p M m mu s = model p m s /\
    forall t, within p M t -> model p m s <= model p m t.
  Proof.
    intros wf l hmu hs total fits.
    assert (e : bound p M m mu s = model p m s).
    { rewrite (model_and_terms p M m mu s), fits. ring. }
    split; [| split; [exact e |]].
    - split; [| exact total]. intros j hj. now apply (minimiser_nonneg p m mu j), hs.
    - rewrite <- e. now apply bound_below_model.
  Qed.

  (** Claim C14. lambda = 0: the masses move to the steepest shape, or away. [low] is at most every
      z_j, and at most zero. *)
  Theorem steepest_shape_bounds_the_optimum p M m low :
    well_formed p -> low <= 0 -> (forall j, (j < shapes p)%nat -> low <= gradient p m j) ->
    forall t, within p M t ->
    objective p m + (M * low - sum (shapes p) (fun j => gradient p m j * m j)) <= objective p t.
  Proof.
    intros wf hlow hz. apply certificate_bounds_the_optimum; [exact wf |].
    intros t [ht total]. unfold model. rewrite sum_add.
    replace (M * low - sum (shapes p) (fun j => gradient p m j * m j)) with
      (M * low - sum (shapes p) (fun j => gradient p m j * m j) + 0) by ring.
    apply le_add.
    - rewrite (sum_ext _ (fun j => gradient p m j * (t j - m j))
        (fun j => gradient p m j * t j - gradient p m j * m j)) by (intros; ring).
      rewrite sum_sub. apply le_of_sub.
      match goal with |- 0 <= ?a - ?c - (?b - ?c) => replace (a - c - (b - c))
          with (a - b) by ring end.
      apply sub_nonneg. apply (le_trans _ (sum (shapes p) t * low)).
      + apply le_sub. replace (sum (shapes p) t * low - M * low) with
          ((M - sum (shapes p) t) * - low) by ring.
        apply mul_nonneg; [now apply sub_nonneg | now apply opp_nonneg].
      + replace (sum (shapes p) t * low) with (low * sum (shapes p) t) by ring.
        rewrite <- sum_scale. apply sum_le. intros j hj.
        replace (low * t j) with (t j * low) by ring.
        replace (gradient p m j * t j) with (t j * gradient p m j) by ring.
        apply le_scale; [now apply ht | now apply hz].
    - apply sum_nonneg. intros j hj. apply mul_nonneg; [apply wf |].
      apply div_nonneg; [apply square_nonneg | now apply wf].
  Qed.
End Certificate.
