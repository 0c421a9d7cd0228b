(** The two ordered fields that the project computes with: the reals, which doubles stand for, and
    the rationals, in which a certificate is checked. *)
From Coq Require Import Reals QArith Qcanon Field.
From Shapeid Require Import ordered_field.

(** Takes the axioms of Coq's real numbers (assumptions.txt). *)
Definition reals : OrderedField.
Proof.
  refine {| carrier := R; zero := R0; one := R1; add := Rplus; mul := Rmult; sub := Rminus;
            opp := Ropp; div := Rdiv; inv := Rinv; le := Rle; field_laws := Rfield |}.
  - exact Rle_refl.
  - exact Rle_antisym.
  - exact Rle_trans.
  - intros x y. destruct (Rle_or_lt x y); [now left | right; now apply Rlt_le].
  - intros x y. destruct (Rle_dec x y); [now left | now right].
  - intros x y z h. now apply Rplus_le_compat_r.
  - intros x y hx hy. now apply Rmult_le_pos.
Defined.

(** Takes no axiom. *)
Definition rationals : OrderedField.
Proof.
  refine {| carrier := Qc; zero := Q2Qc 0%Q; one := Q2Qc 1%Q; add := Qcplus; mul := Qcmult;
            sub := Qcminus; opp := Qcopp; div := Qcdiv; inv := Qcinv; le := Qcle;
            field_laws := Qcft |}.
  - exact Qcle_refl.
  - exact Qcle_antisym.
  - exact Qcle_trans.
  - intros x y. destruct (Qclt_le_dec x y) as [h | h]; [left; now apply Qclt_le_weak | now right].
  - intros x y. destruct (Qclt_le_dec y x) as [h | h]; [right | now left].
    now apply Qclt_not_le.
  - intros x y z h. apply Qcplus_le_compat; [exact h | apply Qcle_refl].
  - intros x y hx hy. replace (Q2Qc 0%Q) with (Q2Qc 0%Q * y)%Qc by ring.
    now apply Qcmult_le_compat_r.
Defined.
