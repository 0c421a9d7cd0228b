(** The floor as the certificate checker proves it: from any residual whatever, so that nothing is
    asked of the parameters that it came from. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums space mass_problem body floor duality.

Section ResidualFloor.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (q : MassProblem K) (t : nat -> K).

  (** g = Y^T W r *)
  Definition half_slope q (r : nat -> K) (k : nat) : K :=
    sum (rows q) (fun i => Y q i k * (W q i * r i)).

  (** Claim C15. No set of shapes in the regions has an objective below
      - r^T W r - 2 F^T W r + 2 M min(0, lowest price), for any r. *)
  Theorem floor_from_any_residual q r links region link shape M low :
    well_formed q -> made_of q links region link shape -> low <= 0 ->
    (forall l x, (l < links)%nat -> region l x -> low <= price (half_slope q r) l x) ->
    forall t, nonnegative q t -> sum (shapes q) t <= M ->
    constant_terms q r + 2 * (M * low) <= objective q t.
  Proof.
    intros wf made hlow bound t ht total.
    pose (none := {| others := 0; C := fun _ _ => (0 : K) |}).
    assert (whole : full_objective q none t (fun _ => 0) = objective q t).
    { unfold full_objective, objective, data, data_of. f_equal. apply sum_ext. intros i _.
      unfold full_residual, others_at. cbn. ring. }
    assert (prices : forall j, (j < shapes q)%nat -> low <= mass_slope q r j).
    { intros j hj. unfold mass_slope.
      rewrite (sum_ext (parameters q) _ (fun k => half_slope q r k * U q k j)).
      - rewrite (column_price q links region link shape _ j made hj).
        apply (price_of_a_body (region (link j))).
        + now apply (some_volume _ _ _ _ _ made).
        + now apply (inside _ _ _ _ _ made).
        + intros x hx. apply bound; [now apply (on_a_link _ _ _ _ _ made) | exact hx].
      - intros k _. unfold half_slope. ring. }
    assert (masses : 2 * (M * low) <= mass_terms q (mass_slope q r) t).
    { unfold mass_terms. replace (2 * (M * low)) with (2 * (M * low) + 0) by ring. apply le_add.
      - rewrite (sum_ext (shapes q) _ (fun j => 2 * (mass_slope q r j * t j))) by (intros; ring).
        rewrite sum_scale. apply le_scale; [apply lt_le, two_pos |].
        apply (le_trans _ (low * sum (shapes q) t)).
        + apply le_of_sub.
          replace (low * sum (shapes q) t - M * low) with ((M - sum (shapes q) t) * - low) by ring.
          apply mul_nonneg; [now apply sub_nonneg | now apply opp_nonneg].
        + rewrite <- sum_scale. apply sum_le. intros j hj.
          replace (low * t j) with (t j * low) by ring.
          replace (mass_slope q r j * t j) with (t j * mass_slope q r j) by ring.
          apply le_scale; [now apply ht | now apply prices].
      - unfold density. apply mul_nonneg; [apply wf |]. apply sum_nonneg. intros j hj.
        apply div_nonneg; [apply square_nonneg | now apply wf]. }
    rewrite <- whole.
    replace (constant_terms q r + 2 * (M * low)) with
      (constant_terms q r + 2 * (M * low) + 0) by ring.
    apply weak_duality; [exact wf | exact masses |].
    unfold other_terms. cbn. apply le_refl.
  Qed.
End ResidualFloor.
