(** Riemann's integral of a polynomial, for the moments of shapes. *)
From Coq Require Import Reals Lra FunctionalExtensionality.
From Shapeid Require Import ordered_field numbers.
Local Open Scope R_scope.

(** The operations of [reals] by their own names, for Coq's tactics. *)
Ltac by_name :=
  change (@add reals) with Rplus in *; change (@mul reals) with Rmult in *;
  change (@sub reals) with Rminus in *; change (@opp reals) with Ropp in *;
  change (@div reals) with Rdiv in *; change (@inv reals) with Rinv in *;
  change (@zero reals) with 0 in *; change (@one reals) with 1 in *;
  change (carrier reals) with R in *.

Definition is_integral (f : R -> R) (a b value : R) : Prop :=
  exists h : Riemann_integrable f a b, RiemannInt h = value.

(** The fundamental theorem, for an antiderivative that is known. *)
Lemma integral_by_antiderivative f F a b :
  a <= b -> continuity f -> (forall x, derivable_pt_lim F x (f x)) ->
  is_integral f a b (F b - F a).
Proof.
  intros ab continuous slope.
  pose (d := (fun x => exist _ (f x) (slope x)) : derivable F).
  assert (same : derive F d = f) by (apply functional_extensionality; reflexivity).
  assert (h : Riemann_integrable (derive F d) a b).
  { rewrite same. apply continuity_implies_RiemannInt; [exact ab | intros; apply continuous]. }
  assert (smooth : continuity (derive F d)) by now rewrite same.
  pose proof (FTC_Riemann (mkC1 smooth) h) as value. cbn in value.
  revert h value. rewrite same. intros h value. now exists h.
Qed.

(** Order four is what a second moment of a tetrahedron takes. *)
Lemma is_integral_of c0 c1 c2 c3 c4 (f : R -> R) a b value :
  a <= b ->
  (forall x, f x = c0 + c1 * x + c2 * (x * x) + c3 * (x * x * x) + c4 * (x * x * x * x)) ->
  value = c0 * (b - a) + c1 * (b * b - a * a) / 2 + c2 * (b * b * b - a * a * a) / 3 +
          c3 * (b * b * b * b - a * a * a * a) / 4 +
          c4 * (b * b * b * b * b - a * a * a * a * a) / 5 ->
  is_integral f a b value.
Proof.
  intros ab same ->.
  assert (whole : f = fun x => c0 + c1 * x + c2 * (x * x) + c3 * (x * x * x) + c4 * (x * x * x * x))
    by (apply functional_extensionality; exact same).
  subst f. clear same.
  pose (F := fun x => c0 * x + c1 / 2 * (x * x) + c2 / 3 * (x * x * x) + c3 / 4 * (x * x * x * x) +
                      c4 / 5 * (x * x * x * x * x)).
  match goal with |- is_integral ?f a b ?v => replace v with (F b - F a) by (unfold F; field) end.
  apply integral_by_antiderivative; [exact ab | reg |].
  intro x. unfold F.
  match goal with |- derivable_pt_lim _ _ ?v => replace v with
    (c0 * 1 + c1 / 2 * (1 * x + x * 1) + c2 / 3 * ((1 * x + x * 1) * x + x * x * 1) +
     c3 / 4 * (((1 * x + x * 1) * x + x * x * 1) * x + x * x * x * 1) +
     c4 / 5 * ((((1 * x + x * 1) * x + x * x * 1) * x + x * x * x * 1) * x + x * x * x * x * 1))
    by field end.
  repeat first
    [ apply derivable_pt_lim_plus | apply derivable_pt_lim_scal
    | apply (derivable_pt_lim_mult (fun x => x * x * x * x) (fun x => x))
    | apply (derivable_pt_lim_mult (fun x => x * x * x) (fun x => x))
    | apply (derivable_pt_lim_mult (fun x => x * x) (fun x => x))
    | apply (derivable_pt_lim_mult (fun x => x) (fun x => x)) | apply derivable_pt_lim_id ].
Qed.
