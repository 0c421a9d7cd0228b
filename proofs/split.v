(** A shape is cut in two and keeps its density: nothing changes, and the optimum never rises. *)
From Coq Require Import Ring Field Arith Lia.
From Shapeid Require Import ordered_field sums mass_problem.

Section Split.
  Context {K : OrderedField}.
  Add Field numbers : (field_laws K).
  Implicit Types (p q : MassProblem K) (m t : nat -> K).

  (** [q] is [p] with shape [j] cut: the first part takes its place, the second is appended. The
      columns of the parts add up to the whole's by volume (body.v: whatever is cut by whatever
      surface). All rows, weights and lambda stay. *)
  Record cut p q (j : nat) : Prop := {
    place : (j < shapes p)%nat;
    one_more : shapes q = S (shapes p);
    same_rows : rows q = rows p /\ parameters q = parameters p;
    same_data : (forall i k, Y q i k = Y p i k) /\ (forall i, F q i = F p i /\ W q i = W p i);
    same_lambda : lambda q = lambda p;
    other_columns : forall k i, (i < shapes p)%nat -> i <> j -> U q k i = U p k i;
    other_volumes : forall i, (i < shapes p)%nat -> i <> j -> V q i = V p i;
    volumes : V p j = V q j + V q (shapes p);
    positive_volumes : 0 < V q j /\ 0 < V q (shapes p);
    columns : forall k, V p j * U p k j = V q j * U q k j + V q (shapes p) * U q k (shapes p)
  }.

  (** Masses after the cut: m1 = m V1 / V and m2 = m V2 / V. *)
  Definition equal_density p q (j : nat) m (i : nat) : K :=
    if i =? j then m j * V q j / V p j
    else if i =? shapes p then m j * V q (shapes p) / V p j
    else m i.

  Section OneCut.
    Variables (p q : MassProblem K) (j : nat) (m : nat -> K).
    Hypothesis is_cut : cut p q j.
    Let V1 := V q j.
    Let V2 := V q (shapes p).

    Lemma whole_positive : 0 < V p j.
    Proof.
      rewrite (volumes _ _ _ is_cut). destruct (positive_volumes _ _ _ is_cut).
      apply add_pos; [assumption | now apply lt_le].
    Qed.

    Lemma at_place : equal_density p q j m j = m j * V1 / V p j.
    Proof. unfold equal_density. now rewrite Nat.eqb_refl. Qed.

    Lemma at_end : equal_density p q j m (shapes p) = m j * V2 / V p j.
    Proof.
      unfold equal_density. rewrite Nat.eqb_refl.
      destruct (Nat.eqb_spec (shapes p) j) as [e | _]; [| reflexivity].
      pose proof (place _ _ _ is_cut). lia.
    Qed.

    Lemma elsewhere i : (i < shapes p)%nat -> i <> j -> equal_density p q j m i = m i.
    Proof.
      intros hi no. unfold equal_density.
      destruct (Nat.eqb_spec i j); [contradiction |].
      destruct (Nat.eqb_spec i (shapes p)); [lia | reflexivity].
    Qed.

    (** Claim C4. A cut at equal density leaves the parameters as they were. *)
    Theorem split_keeps_parameters k : Phi q (equal_density p q j m) k = Phi p m k.
    Proof.
      unfold Phi. rewrite (one_more _ _ _ is_cut). apply (sum_split _ j).
      - apply (place _ _ _ is_cut).
      - rewrite at_place, at_end. fold V1 V2.
        transitivity ((V1 * U q k j + V2 * U q k (shapes p)) * m j / V p j).
        { rewrite !div_mul. ring. }
        unfold V1, V2. rewrite <- (columns _ _ _ is_cut).
        field. apply pos_nonzero, whole_positive.
      - intros i hi no. now rewrite (other_columns _ _ _ is_cut), elsewhere.
    Qed.

    (** Claim C4. ... and the density term. *)
    Theorem split_keeps_density : density q (equal_density p q j m) = density p m.
    Proof.
      unfold density. rewrite (same_lambda _ _ _ is_cut). f_equal.
      rewrite (one_more _ _ _ is_cut). apply (sum_split _ j).
      - apply (place _ _ _ is_cut).
      - rewrite at_place, at_end. fold V1 V2.
        pose proof whole_positive as whole. destruct (positive_volumes _ _ _ is_cut) as [p1 p2].
        transitivity (m j * m j * (V1 + V2) / (V p j * V p j)).
        { field. repeat split; now apply pos_nonzero. }
        unfold V1, V2. rewrite <- (volumes _ _ _ is_cut). field. now apply pos_nonzero.
      - intros i hi no. now rewrite (other_volumes _ _ _ is_cut), elsewhere.
    Qed.

    Lemma split_keeps_data : data q (equal_density p q j m) = data p m.
    Proof.
      unfold data, data_of. destruct (same_rows _ _ _ is_cut) as [er ep].
      destruct (same_data _ _ _ is_cut) as [ey efw]. rewrite er. apply sum_ext. intros i _.
      destruct (efw i) as [ef ew]. rewrite ew.
      assert (r : residual q (Phi q (equal_density p q j m)) i = residual p (Phi p m) i).
      { unfold residual. rewrite ef, ep. f_equal. apply sum_ext. intros k _.
        now rewrite ey, split_keeps_parameters. }
      now rewrite r.
    Qed.

    (** Claim C4. ... and the objective. *)
    Theorem split_keeps_objective : objective q (equal_density p q j m) = objective p m.
    Proof. unfold objective. now rewrite split_keeps_data, split_keeps_density. Qed.

    Lemma split_keeps_sign : nonnegative p m -> nonnegative q (equal_density p q j m).
    Proof.
      intros hm i hi. rewrite (one_more _ _ _ is_cut) in hi.
      destruct (positive_volumes _ _ _ is_cut) as [p1 p2].
      assert (mj : 0 <= m j) by (apply hm, (place _ _ _ is_cut)).
      destruct (Nat.eq_dec i j) as [-> | no].
      - rewrite at_place. apply div_nonneg; [| apply whole_positive].
        apply mul_nonneg; [exact mj | now apply lt_le].
      - destruct (Nat.eq_dec i (shapes p)) as [-> | no'].
        + rewrite at_end. apply div_nonneg; [| apply whole_positive].
          apply mul_nonneg; [exact mj | now apply lt_le].
        + rewrite elsewhere by (try exact no; lia). apply hm. lia.
    Qed.
  End OneCut.

  (** Claim C4. ... and the total mass, so a declared bound of it stays one. *)
  Theorem split_keeps_mass p q j m :
    cut p q j -> sum (shapes q) (equal_density p q j m) = sum (shapes p) m.
  Proof.
    intro c. rewrite (one_more _ _ _ c). apply (sum_split _ j); [apply (place _ _ _ c) | |].
    - rewrite (at_place p q), (at_end p q) by exact c.
      pose proof (whole_positive p q j c) as whole.
      transitivity (m j * (V q j + V q (shapes p)) / V p j); [rewrite !div_mul; ring |].
      rewrite <- (volumes _ _ _ c). field. now apply pos_nonzero.
    - intros i hi no. now apply elsewhere.
  Qed.

  (** Any number of cuts, one after the other. *)
  Inductive divided : MassProblem K -> MassProblem K -> Prop :=
  | undivided p : divided p p
  | divided_once_more p q r j : divided p q -> cut q r j -> divided p r.

  (** What was possible before the divisions is possible after them, at the same value. *)
  Lemma divisions_lose_nothing p q m :
    divided p q -> nonnegative p m ->
    exists t, nonnegative q t /\ objective q t = objective p m /\
              (forall k, Phi q t k = Phi p m k) /\ sum (shapes q) t = sum (shapes p) m.
  Proof.
    intros d. revert m. induction d as [p | p q r j d IH c]; intros m hm.
    - now exists m.
    - destruct (IH m hm) as [t [ht [ef [ep es]]]]. exists (equal_density q r j t).
      repeat split.
      + now apply split_keeps_sign.
      + rewrite split_keeps_objective; assumption.
      + intro k. rewrite split_keeps_parameters; [apply ep | exact c].
      + rewrite split_keeps_mass; assumption.
  Qed.

  (** Claim C5. The optimum never rises, however many divisions are made. *)
  Theorem optimum_never_rises p q m t :
    divided p q -> optimal p m -> optimal q t -> objective q t <= objective p m.
  Proof.
    intros d [hm _] [_ best]. destruct (divisions_lose_nothing p q m d hm) as [s [hs [e _]]].
    rewrite <- e. now apply best.
  Qed.

  (** Claim C5. The same of the greatest lower bound, where no optimum need be attained. *)
  Theorem lower_bounds_before p q b :
    divided p q -> (forall t, nonnegative q t -> b <= objective q t) ->
    forall m, nonnegative p m -> b <= objective p m.
  Proof.
    intros d bound m hm. destruct (divisions_lose_nothing p q m d hm) as [s [hs [e _]]].
    rewrite <- e. now apply bound.
  Qed.

  (** Claim C4. What the other theorems ask of a problem stays true of it. *)
  Theorem split_keeps_well_formed p q j : cut p q j -> well_formed p -> well_formed q.
  Proof.
    intros c [w [v l]]. destruct (same_rows _ _ _ c) as [er _].
    destruct (same_data _ _ _ c) as [_ efw].
    destruct (positive_volumes _ _ _ c) as [p1 p2].
    refine (conj _ (conj _ _)).
    - intros i hi. rewrite er in hi. destruct (efw i) as [_ ->]. now apply w.
    - intros i hi. rewrite (one_more _ _ _ c) in hi.
      destruct (Nat.eq_dec i j) as [-> | no]; [exact p1 |].
      destruct (Nat.eq_dec i (shapes p)) as [-> | no']; [exact p2 |].
      rewrite (other_volumes _ _ _ c) by (try exact no; lia). apply v. lia.
    - rewrite (same_lambda _ _ _ c). exact l.
  Qed.
End Split.
