# Claim C6. Rounding of the radial moments of an ellipsoid's sector, models/ellipsoid.cpp:
#   : m(0.5 * (cell.lower[0] + cell.upper[0])), width(cell.upper[0] - cell.lower[0]) {
#   q = width * width;
#   [[nodiscard]] double mean_weight() const { return m * m + q / 12.0; }
#   [[nodiscard]] double weight() const { return width * mean_weight(); }
#   [[nodiscard]] double mean() const { return m * (m * m + q / 4.0) / mean_weight(); }
#   const double m2 = m * m;
#   return q * (m2 * m2 / 12.0 - m2 * q / 120.0 + q * q / 960.0) / (mean_weight() * mean_weight());
# Bounds are doubles with 0 <= a < b <= 1, so that the width is at most twice the middle: Q / M^2 is
# at most 4. Nothing is below 2^-100, so that no fourth power underflows.
@rnd = float<ieee_64, ne>;

a = rnd(dummy1);
b = rnd(dummy2);

m rnd= 0.5 * (a + b);   M = 0.5 * (a + b);
width rnd= b - a;       Width = b - a;
q rnd= width * width;   Q = Width * Width;
m2 rnd= m * m;          M2 = M * M;
Share = Q / M2;

mean_weight rnd= m * m + q / 12;
MeanWeight = M2 + Q / 12;
weight rnd= width * mean_weight;
Weight = Width * MeanWeight;

mean rnd= m * (m * m + q / 4) / mean_weight;
Mean = M * (M2 + Q / 4) / MeanWeight;

fourth rnd= m2 * m2 / 12 - m2 * q / 120;
Fourth = M2 * M2 / 12 - M2 * Q / 120;
inner rnd= fourth + q * q / 960;
Inner = Fourth + Q * Q / 960;
variance rnd= q * inner / (mean_weight * mean_weight);
Variance = Q * Inner / (MeanWeight * MeanWeight);

{ a in [0, 1] /\ b in [0, 1] /\ Width in [1b-100, 1] /\ M in [1b-100, 1] /\ Share in [1b-200, 4]
->
   weight -/ Weight in [-8b-53, 8b-53]
/\ mean -/ Mean in [-16b-53, 16b-53]
/\ variance -/ Variance in [-50b-53, 50b-53] }

# The parts of the sums as shares of them.
M2 / MeanWeight -> 1 / (1 + Share / 12) { M <> 0, MeanWeight <> 0 };
(Q / 12) / MeanWeight -> 1 / (1 + 12 / Share) { M <> 0, Width <> 0, MeanWeight <> 0 };
M2 / (M2 + Q / 4) -> 1 / (1 + Share / 4) { M <> 0 };
(Q / 4) / (M2 + Q / 4) -> 1 / (1 + 4 / Share) { M <> 0, Width <> 0 };
(M2 * M2 / 12) / Fourth -> 1 / (1 - Share / 10) { M <> 0, Fourth <> 0 };
(M2 * Q / 120) / Fourth -> (Share / 10) / (1 - Share / 10) { M <> 0, Fourth <> 0 };
Fourth / Inner -> 1 / (1 + Share * Share / (80 - 8 * Share)) { M <> 0, Inner <> 0 };
(Q * Q / 960) / Inner -> (Share * Share / (80 - 8 * Share)) / (1 + Share * Share / (80 - 8 * Share)) { M <> 0, Inner <> 0 };
Fourth -> M2 * M2 * (1 - Share / 10) / 12 { M <> 0 };
