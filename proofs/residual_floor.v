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
    pose proof (steepest_shape q (mass_slope q r) t M low wf hlow prices ht total) as masses.
    rewrite <- whole.
    replace (constant_terms q r + 2 * (M * low)) with
      (constant_terms q r + 2 * (M * low) + 0) by ring.
    apply weak_duality; [exact wf | exact masses |].
    unfold other_terms. cbn. apply le_refl.
  Qed.
End ResidualFloor.
