(** The order of relaxations, at lambda = 0: what parameters may be asks less than what shapes can
    make, so its optimum is not above. *)
From Coq Require Import Ring Field.
From Shapeid Require Import ordered_field sums space mass_problem consistency.

Section Relaxations.
  Context {K : OrderedField}.
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
End Relaxations.
