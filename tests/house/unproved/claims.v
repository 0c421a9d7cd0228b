(** What proofs/check must refuse: a claim that is admitted, not proved. *)
Theorem nothing_is_proved : False.
Admitted.
