(** The closed moments of models/cylinder.cpp are Riemann integrals over the sector, r dr dphi dz,
    in axes whose x points along the middle of the arc (docs/derivations/shapes.md, section 6). *)
From Coq Require Import Reals Lra.
From Shapeid Require Import integral.
Local Open Scope R_scope.

(** [F] is an antiderivative of the continuous [f]. *)
Definition antiderivative_of (F f : R -> R) : Prop :=
  continuity f /\ forall x, derivable_pt_lim F x (f x).

Lemma antiderivative_scaled F f c :
  antiderivative_of F f -> antiderivative_of (fun x => c * F x) (fun x => c * f x).
Proof.
  intros [continuous slope]. split.
  - change (continuity (mult_real_fct c f)). now apply continuity_scal.
  - intro x. now apply derivable_pt_lim_scal.
Qed.

Lemma integral_of F f a b value :
  antiderivative_of F f -> a <= b -> value = F b - F a -> is_integral f a b value.
Proof. intros [continuous slope] ab ->. now apply integral_by_antiderivative. Qed.

Section Sector.
  (** Radius from n - w / 2 to n + w / 2, angle from -h to h, z from lo to up. *)
  Variables n w h lo up : R.
  Hypothesis radius : 0 < n /\ 0 <= w.
  Hypothesis angle : 0 < h.
  Hypothesis height : lo <= up.

  (** One coordinate after the other, r outermost, of f(x, y, z) r dr dphi dz. *)
  Definition sector_integral (f : R -> R -> R -> R) (value : R) : Prop :=
    exists (over_z : R -> R -> R) (over_tz : R -> R),
      (forall r t, is_integral (fun z => f (r * cos t) (r * sin t) z * r) lo up (over_z r t)) /\
      (forall r, is_integral (fun t => over_z r t) (- h) h (over_tz r)) /\
      is_integral (fun r => over_tz r) (n - w / 2) (n + w / 2) value.

  (** A product of functions of one coordinate each is integrated one by one. *)
  Lemma separable f (R0 T0 Z0 R1 T1 Z1 : R -> R) value :
    antiderivative_of R1 R0 -> antiderivative_of T1 T0 -> antiderivative_of Z1 Z0 ->
    (forall r t z, f (r * cos t) (r * sin t) z * r = R0 r * T0 t * Z0 z) ->
    value = (R1 (n + w / 2) - R1 (n - w / 2)) * (T1 h - T1 (- h)) * (Z1 up - Z1 lo) ->
    sector_integral f value.
  Proof.
    intros hr ht hz product ->.
    set (dz := Z1 up - Z1 lo). set (dt := T1 h - T1 (- h)).
    exists (fun r t => R0 r * dz * T0 t). exists (fun r => dz * dt * R0 r).
    split; [| split].
    - intros r t.
      replace (fun z => f (r * cos t) (r * sin t) z * r) with (fun z => R0 r * T0 t * Z0 z).
      + apply (integral_of (fun z => R0 r * T0 t * Z1 z));
          [now apply antiderivative_scaled | exact height | unfold dz; ring].
      + apply FunctionalExtensionality.functional_extensionality. intro z. now rewrite product.
    - intro r. apply (integral_of (fun t => R0 r * dz * T1 t));
        [now apply antiderivative_scaled | lra | unfold dt; ring].
    - apply (integral_of (fun r => dz * dt * R1 r));
        [now apply antiderivative_scaled | lra | ring].
  Qed.

  (** Radial of models/cylinder.cpp *)
  Definition mean_r : R := n + w * w / (12 * n).
  Definition mean_square_r : R := n * n + w * w / 4.
  Definition variance_r : R := w * w / 12 * (1 - w * w / (12 * n * n)).

  (** Arc of models/arc.cpp, in the closed forms that its series stand for. *)
  Definition sinc (x : R) : R := sin x / x.
  Definition mean_cos : R := sinc h.
  Definition mean_sin2 : R := (1 - sinc (2 * h)) / 2.
  Definition mean_cos2 : R := 1 - mean_sin2.
  Definition variance_cos : R := (1 + sinc (2 * h)) / 2 - sinc h * sinc h.

  (** canonical_moments of models/cylinder.cpp *)
  Definition sector_volume : R := n * w * (2 * h) * (up - lo).
  Definition centre_x : R := mean_r * mean_cos.
  Definition centre_z : R := (lo + up) / 2.
  Definition spread_x : R := variance_r * mean_cos2 + mean_r * mean_r * variance_cos.
  Definition spread_y : R := mean_square_r * mean_sin2.
  Definition spread_z : R := (up - lo) * (up - lo) / 12.

  (** Antiderivatives of the powers of r with the weight r, and of z, *)
  Lemma of_one : antiderivative_of (fun x => x) (fun _ => 1).
  Proof. split; [reg | intro x; apply derivable_pt_lim_id]. Qed.

  Lemma of_power k : antiderivative_of (fun x => x ^ S k / INR (S k)) (fun x => x ^ k).
  Proof.
    assert (no : INR (S k) <> 0) by (apply not_0_INR; discriminate).
    split; [reg |]. intro x.
    replace (x ^ k) with (/ INR (S k) * (INR (S k) * x ^ pred (S k))) by (cbn [pred]; now field).
    apply (derivable_pt_lim_ext (fun x => / INR (S k) * x ^ S k)).
    - intro y. now field.
    - apply (derivable_pt_lim_scal (fun y => y ^ S k)). apply derivable_pt_lim_pow.
  Qed.

  (** ... and of what the angle multiplies. *)
  Lemma of_cos : antiderivative_of sin cos.
  Proof. split; [apply continuity_cos | apply derivable_pt_lim_sin]. Qed.

  Lemma of_sin : antiderivative_of (fun t => - 1 * cos t) sin.
  Proof.
    split; [apply continuity_sin |]. intro t. replace (sin t) with (- 1 * - sin t) by ring.
    apply derivable_pt_lim_scal, derivable_pt_lim_cos.
  Qed.

  Lemma slope_of_sin_cos t :
    derivable_pt_lim (fun x => sin x * cos x) t (cos t * cos t + sin t * - sin t).
  Proof.
    apply derivable_pt_lim_mult; [apply derivable_pt_lim_sin | apply derivable_pt_lim_cos].
  Qed.

  Lemma of_cos_cos :
    antiderivative_of (fun t => / 2 * (t + sin t * cos t)) (fun t => cos t * cos t).
  Proof.
    split; [reg |]. intro t.
    replace (cos t * cos t) with (/ 2 * (1 + (cos t * cos t + sin t * - sin t))).
    - apply derivable_pt_lim_scal, derivable_pt_lim_plus;
        [apply derivable_pt_lim_id | apply slope_of_sin_cos].
    - pose proof (sin2_cos2 t) as one. unfold Rsqr in one. lra.
  Qed.

  Lemma of_sin_sin :
    antiderivative_of (fun t => / 2 * (t - sin t * cos t)) (fun t => sin t * sin t).
  Proof.
    split; [reg |]. intro t.
    replace (sin t * sin t) with (/ 2 * (1 - (cos t * cos t + sin t * - sin t))).
    - apply derivable_pt_lim_scal, derivable_pt_lim_minus;
        [apply derivable_pt_lim_id | apply slope_of_sin_cos].
    - pose proof (sin2_cos2 t) as one. unfold Rsqr in one. lra.
  Qed.

  Lemma of_sin_cos :
    antiderivative_of (fun t => / 2 * (sin t * sin t)) (fun t => sin t * cos t).
  Proof.
    split; [reg |]. intro t.
    replace (sin t * cos t) with (/ 2 * (cos t * sin t + sin t * cos t)) by field.
    apply derivable_pt_lim_scal, derivable_pt_lim_mult; apply derivable_pt_lim_sin.
  Qed.

  Local Ltac closed := cbn [pow INR]; unfold sector_volume, centre_x, centre_z, spread_x, spread_y,
    spread_z, mean_r, mean_square_r, variance_r, mean_cos2, mean_sin2, variance_cos, mean_cos, sinc;
    rewrite ?sin_neg, ?cos_neg, ?sin_2a; field; lra.

  (** Claim C6. The volume of a cylinder's sector, and where its centre is. *)
  Theorem sector_centre_is_an_integral :
    sector_integral (fun _ _ _ => 1) sector_volume /\
    sector_integral (fun x _ _ => x) (sector_volume * centre_x) /\
    sector_integral (fun _ y _ => y) 0 /\
    sector_integral (fun _ _ z => z) (sector_volume * centre_z).
  Proof.
    split; [| split; [| split]].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 1) of_one of_one); [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 2) of_cos of_one); [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 2) of_sin of_one); [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 1) of_one (of_power 1));
        [intros; cbn; ring | closed].
  Qed.

  (** Claim C6. Its second moments: the code's covariance, and the centre's. *)
  Theorem sector_spread_is_an_integral :
    sector_integral (fun x _ _ => x * x) (sector_volume * (spread_x + centre_x * centre_x)) /\
    sector_integral (fun _ y _ => y * y) (sector_volume * spread_y) /\
    sector_integral (fun _ _ z => z * z) (sector_volume * (spread_z + centre_z * centre_z)) /\
    sector_integral (fun x y _ => x * y) 0 /\
    sector_integral (fun x _ z => x * z) (sector_volume * (centre_x * centre_z)) /\
    sector_integral (fun _ y z => y * z) 0.
  Proof.
    split; [| split; [| split; [| split; [| split]]]].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 3) of_cos_cos of_one);
        [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 3) of_sin_sin of_one);
        [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 1) of_one (of_power 2));
        [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 3) of_sin_cos of_one);
        [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 2) of_cos (of_power 1));
        [intros; cbn; ring | closed].
    - apply (separable _ _ _ _ _ _ _ _ (of_power 2) of_sin (of_power 1));
        [intros; cbn; ring | closed].
  Qed.
End Sector.
