(** The order of relaxations, at lambda = 0: what parameters may be asks less than what shapes can
    make, so its optimum is not above. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field sums space mass_problem consistency.

Section Relaxations.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p : MassProblem K) (x m : nat -> K).

  (** Ten parameters of each link that can exist. *)
  Definition all_consistent (links : nat) x : Prop :=
    forall l, (l < links)%nat -> consistent (fun k => x (10 * l + k)%nat).

  (** Only that no link has negative mass. *)
  Definition masses_nonnegative (links : nat) x : Prop :=
    forall l, (l < links)%nat -> 0 <= x (10 * l)%nat.

  (** Claim C7. Optimum (mass >= 0 only) <= optimum (bodies that can exist) <= optimum (any shapes
      that can exist): each lower bound of one is a lower bound of the next. *)
  Theorem relaxations_come_in_order p links b :
    ((forall x, masses_nonnegative links x -> b <= data_of p x) ->
     forall x, all_consistent links x -> b <= data_of p x) /\
    ((forall x, all_consistent links x -> b <= data_of p x) ->
     (forall l j, (l < links)%nat -> (j < shapes p)%nat ->
        consistent (fun k => U p (10 * l + k)%nat j)) ->
     forall m, nonnegative p m -> b <= data p m).
  Proof.
    split.
    - intros bound x hx. apply bound. intros l hl.
      pose proof (consistent_mass _ (hx l hl)) as h. unfold mass in h.
      now rewrite <- plus_n_O in h.
    - intros bound shapes_exist m hm. apply bound. intros l hl.
      apply nonnegative_masses_are_consistent; [| exact hm]. intros j hj. now apply shapes_exist.
  Qed.

  Definition mass_of_all (links : nat) x : K := sum links (fun l => x (10 * l)%nat).

  Lemma mass_of_what_shapes_make p links m :
    (forall j, (j < shapes p)%nat -> sum links (fun l => U p (10 * l)%nat j) <= 1) ->
    nonnegative p m -> mass_of_all links (Phi p m) <= sum (shapes p) m.
  Proof.
    intros unit hm. unfold mass_of_all, Phi. rewrite sum_swap. apply sum_le. intros j hj.
    rewrite (sum_ext links _ (fun l => m j * U p (10 * l)%nat j)) by (intros; ring).
    rewrite sum_scale. replace (m j) with (m j * 1) at 2 by ring.
    apply le_scale; [now apply hm | now apply unit].
  Qed.

  (** Claim C7. The same where no more than a mass M is allowed, in each of the three sets: of
      shapes whose columns weigh no more than their mass. *)
  Theorem relaxations_come_in_order_at_most_the_mass p links M b :
    ((forall x, masses_nonnegative links x -> mass_of_all links x <= M -> b <= data_of p x) ->
     forall x, all_consistent links x -> mass_of_all links x <= M -> b <= data_of p x) /\
    ((forall x, all_consistent links x -> mass_of_all links x <= M -> b <= data_of p x) ->
     (forall l j, (l < links)%nat -> (j < shapes p)%nat ->
        consistent (fun k => U p (10 * l + k)%nat j)) ->
     (forall j, (j < shapes p)%nat -> sum links (fun l => U p (10 * l)%nat j) <= 1) ->
     forall m, nonnegative p m -> sum (shapes p) m <= M -> b <= data p m).
  Proof.
    split.
    - intros bound x hx total. apply bound; [| exact total]. intros l hl.
      pose proof (consistent_mass _ (hx l hl)) as h. unfold mass in h.
      now rewrite <- plus_n_O in h.
    - intros bound shapes_exist unit m hm total. apply bound.
      + intros l hl. apply nonnegative_masses_are_consistent; [| exact hm]. intros j hj.
        now apply shapes_exist.
      + apply (le_trans _ (sum (shapes p) m)); [| exact total].
        now apply mass_of_what_shapes_make.
  Qed.
End Relaxations.
