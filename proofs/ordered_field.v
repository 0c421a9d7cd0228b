(** Ordered fields: what the theorems need of numbers. Reals and rationals are two of them
    (numbers.v), so that what is proved for every ordered field holds for exact rational
    arithmetic too, and takes no axiom. *)
From Coq Require Import Ring Field.

Record OrderedField := {
  carrier :> Type;
  zero : carrier;
  one : carrier;
  add : carrier -> carrier -> carrier;
  mul : carrier -> carrier -> carrier;
  sub : carrier -> carrier -> carrier;
  opp : carrier -> carrier;
  div : carrier -> carrier -> carrier;
  inv : carrier -> carrier;
  le : carrier -> carrier -> Prop;
  field_laws : field_theory zero one add mul sub opp div inv eq;
  le_refl : forall x, le x x;
  le_antisym : forall x y, le x y -> le y x -> x = y;
  le_trans : forall x y z, le x y -> le y z -> le x z;
  le_total : forall x y, le x y \/ le y x;
  le_decided : forall x y, le x y \/ ~ le x y;
  add_le : forall x y z, le x y -> le (add x z) (add y z);
  mul_nonneg : forall x y, le zero x -> le zero y -> le zero (mul x y)
}.

Arguments zero {_} : simpl never.
Arguments one {_} : simpl never.
Arguments add {_} _ _ : simpl never.
Arguments mul {_} _ _ : simpl never.
Arguments sub {_} _ _ : simpl never.
Arguments opp {_} _ : simpl never.
Arguments div {_} _ _ : simpl never.
Arguments inv {_} _ : simpl never.
Arguments le {_} _ _ : simpl never.
Arguments le_refl {_}.
Arguments le_antisym {_}.
Arguments le_trans {_}.
Arguments le_total {_}.
Arguments le_decided {_}.
Arguments add_le {_}.
Arguments mul_nonneg {_}.

Definition lt {K : OrderedField} (x y : K) : Prop := le x y /\ x <> y.

Declare Scope field_scope.
Delimit Scope field_scope with K.
Notation "0" := zero : field_scope.
Notation "1" := one : field_scope.
Notation "2" := (add one one) : field_scope.
Notation "3" := (add one (add one one)) : field_scope.
Infix "+" := add : field_scope.
Infix "-" := sub : field_scope.
Infix "*" := mul : field_scope.
Infix "/" := div : field_scope.
Notation "- x" := (opp x) : field_scope.
Infix "<=" := le : field_scope.
Infix "<" := lt : field_scope.
Bind Scope field_scope with carrier.
Open Scope field_scope.

Section Order.
  Variable K : OrderedField.
  Add Field numbers : (field_laws K).
  Implicit Types x y z : K.

  Lemma div_mul x y : x / y = x * inv y.
  Proof. apply (Fdiv_def (field_laws K)). Qed.

  Lemma eq_decided x y : x = y \/ x <> y.
  Proof.
    destruct (le_decided x y) as [xy | no].
    - destruct (le_decided y x) as [yx | no].
      + left. now apply le_antisym.
      + right. intros ->. apply no, le_refl.
    - right. intros ->. apply no, le_refl.
  Qed.

  Lemma le_sub x y : x <= y <-> 0 <= y - x.
  Proof.
    split; intro h.
    - apply (add_le _ _ (- x)) in h.
      replace 0 with (x + - x) by ring. replace (y - x) with (y + - x) by ring. exact h.
    - apply (add_le _ _ x) in h.
      replace x with (0 + x) by ring. replace y with (y - x + x) by ring. exact h.
  Qed.

  Lemma sub_nonneg x y : x <= y -> 0 <= y - x.
  Proof. apply le_sub. Qed.

  Lemma le_of_sub x y : 0 <= y - x -> x <= y.
  Proof. apply le_sub. Qed.

  Lemma add_nonneg x y : 0 <= x -> 0 <= y -> 0 <= x + y.
  Proof.
    intros hx hy. apply (le_trans _ y); [exact hy |].
    apply (add_le _ _ y) in hx. replace y with (0 + y) at 1 by ring. exact hx.
  Qed.

  Lemma opp_nonneg x : x <= 0 -> 0 <= - x.
  Proof. intro h. apply le_sub in h. replace (- x) with (0 - x) by ring. exact h. Qed.

  Lemma square_nonneg x : 0 <= x * x.
  Proof.
    destruct (le_total 0 x) as [h | h].
    - now apply mul_nonneg.
    - replace (x * x) with (- x * - x) by ring.
      now apply mul_nonneg; apply opp_nonneg.
  Qed.

  Lemma one_nonneg : 0 <= (1 : K).
  Proof. replace 1 with ((1 : K) * 1) by ring. apply square_nonneg. Qed.

  Lemma one_neq_zero : (1 : K) <> 0.
  Proof. apply (F_1_neq_0 (field_laws K)). Qed.

  Lemma le_add x x' y y' : x <= x' -> y <= y' -> x + y <= x' + y'.
  Proof.
    rewrite (le_sub x), (le_sub y), (le_sub (x + y)). intros hx hy.
    replace (x' + y' - (x + y)) with (x' - x + (y' - y)) by ring.
    now apply add_nonneg.
  Qed.

  Lemma le_scale x y z : 0 <= x -> y <= z -> x * y <= x * z.
  Proof.
    rewrite (le_sub y), (le_sub (x * y)). intros hx hy.
    replace (x * z - x * y) with (x * (z - y)) by ring. now apply mul_nonneg.
  Qed.

  Lemma add_zero x y : 0 <= x -> 0 <= y -> x + y = 0 -> x = 0.
  Proof.
    intros hx hy h. apply le_antisym; [| exact hx].
    apply le_sub. replace (0 - x) with y; [exact hy |].
    replace y with (x + y - x) by ring. rewrite h. ring.
  Qed.

  Lemma mul_zero x y : x * y = 0 -> x = 0 \/ y = 0.
  Proof.
    intro h. destruct (eq_decided x 0) as [-> | no]; [now left | right].
    replace y with (inv x * (x * y)) by (field; exact no). rewrite h. ring.
  Qed.

  Lemma mul_nonzero x y : x <> 0 -> y <> 0 -> x * y <> 0.
  Proof. intros nx ny h. now destruct (mul_zero x y h). Qed.

  Lemma square_zero x : x * x = 0 -> x = 0.
  Proof. intro h. now destruct (mul_zero _ _ h). Qed.

  Lemma lt_le x y : x < y -> x <= y.
  Proof. now intros []. Qed.

  Lemma pos_nonzero x : 0 < x -> x <> 0.
  Proof. intros [_ h] e. now apply h. Qed.

  Lemma inv_nonneg x : 0 < x -> 0 <= inv x.
  Proof.
    intros hx. pose proof (pos_nonzero _ hx) as no.
    replace (inv x) with (x * (inv x * inv x)) by (field; exact no).
    apply mul_nonneg; [now apply lt_le | apply square_nonneg].
  Qed.

  Lemma inv_nonzero x : x <> 0 -> inv x <> 0.
  Proof.
    intros no h. apply one_neq_zero. replace (1 : K) with (x * inv x) by (field; exact no).
    rewrite h. ring.
  Qed.

  Lemma div_nonneg x y : 0 <= x -> 0 < y -> 0 <= x / y.
  Proof. intros hx hy. rewrite div_mul. apply mul_nonneg; [| apply inv_nonneg]; assumption. Qed.

  Lemma mul_pos x y : 0 < x -> 0 < y -> 0 < x * y.
  Proof.
    intros [hx nx] [hy ny]. split; [now apply mul_nonneg |].
    intro h. destruct (mul_zero x y (eq_sym h)) as [e | e]; auto.
  Qed.

  Lemma add_pos x y : 0 < x -> 0 <= y -> 0 < x + y.
  Proof.
    intros [hx nx] hy. split; [now apply add_nonneg |].
    intro h. apply nx. symmetry. now apply (add_zero x y hx hy).
  Qed.

  Lemma one_pos : 0 < (1 : K).
  Proof. split; [apply one_nonneg |]. intro h. now apply one_neq_zero. Qed.

  Lemma two_pos : 0 < (2 : K).
  Proof. apply add_pos; [apply one_pos | apply one_nonneg]. Qed.

  Lemma lt_sub x y : x < y <-> 0 < y - x.
  Proof.
    split; intros [h no]; split.
    - exact (proj1 (le_sub x y) h).
    - intro e. apply no. replace y with (y - x + x) by ring. rewrite <- e. ring.
    - exact (proj2 (le_sub x y) h).
    - intros ->. apply no. ring.
  Qed.

End Order.

Arguments div_mul {K}.
Arguments eq_decided {K}.
Arguments le_sub {K}.
Arguments sub_nonneg {K}.
Arguments le_of_sub {K}.
Arguments add_nonneg {K}.
Arguments opp_nonneg {K}.
Arguments square_nonneg {K}.
Arguments one_nonneg {K}.
Arguments one_neq_zero {K}.
Arguments le_add {K}.
Arguments le_scale {K}.
Arguments add_zero {K}.
Arguments mul_zero {K}.
Arguments mul_nonzero {K}.
Arguments square_zero {K}.
Arguments lt_le {K}.
Arguments pos_nonzero {K}.
Arguments inv_nonneg {K}.
Arguments inv_nonzero {K}.
Arguments div_nonneg {K}.
Arguments mul_pos {K}.
Arguments add_pos {K}.
Arguments one_pos {K}.
Arguments two_pos {K}.
Arguments lt_sub {K}.
