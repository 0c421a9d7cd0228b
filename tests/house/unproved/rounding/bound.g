# What proofs/check must refuse: a product rounds by half a unit in the last place, not by a quarter.
@rnd = float<ieee_64, ne>;
a = rnd(dummy1);
b = rnd(dummy2);
product rnd= a * b;
{ a in [1, 2] /\ b in [1, 2] -> product -/ (a * b) in [-1b-54, 1b-54] }
