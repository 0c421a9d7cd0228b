# Claim C6. Rounding of the radial moments of a cylinder's sector, models/cylinder.cpp:
#   : middle(0.5 * (cell.lower[0] + cell.upper[0])), width(cell.upper[0] - cell.lower[0]) {}
#   [[nodiscard]] double weight() const { return middle * width; }
#   [[nodiscard]] double mean() const { return middle + width * width / (12.0 * middle); }
#   [[nodiscard]] double mean_square() const { return middle * middle + width * width / 4.0; }
#   const double q = width * width;
#   return q / 12.0 * (1.0 - q / (12.0 * middle * middle));
# Bounds are doubles with 0 <= a < b <= 1, so that the width is at most twice the middle: the square
# of Width / Middle is at most 4. Nothing is below 2^-200, so that nothing underflows.
@rnd = float<ieee_64, ne>;

a = rnd(dummy1);
b = rnd(dummy2);

middle rnd= 0.5 * (a + b);  Middle = 0.5 * (a + b);
width rnd= b - a;           Width = b - a;
Share = (Width * Width) / (Middle * Middle);

weight rnd= middle * width;
Weight = Middle * Width;

mean rnd= middle + (width * width) / (12 * middle);
Mean = Middle + (Width * Width) / (12 * Middle);

mean_square rnd= middle * middle + (width * width) / 4;
MeanSquare = Middle * Middle + (Width * Width) / 4;

q rnd= width * width;
variance rnd= q / 12 * (1 - q / ((12 * middle) * middle));
Variance = (Width * Width) / 12 * (1 - (Width * Width) / ((12 * Middle) * Middle));

{ a in [0, 1] /\ b in [0, 1] /\ Width in [1b-200, 1] /\ Middle in [1b-200, 1] /\ Share in [0, 4]
->
   weight -/ Weight in [-4b-53, 4b-53]
/\ mean -/ Mean in [-4b-53, 4b-53]
/\ mean_square -/ MeanSquare in [-6b-53, 6b-53]
/\ variance -/ Variance in [-16b-53, 16b-53] }

# The parts of the sums as shares of them.
Middle / Mean -> 1 / (1 + Share / 12) { Middle <> 0, Mean <> 0 };
((Width * Width) / (12 * Middle)) / Mean -> 1 / (1 + 12 / Share) { Middle <> 0, Width <> 0, Mean <> 0 };
(Middle * Middle) / MeanSquare -> 1 / (1 + Share / 4) { Middle <> 0, MeanSquare <> 0 };
((Width * Width) / 4) / MeanSquare -> 1 / (1 + 4 / Share) { Middle <> 0, Width <> 0, MeanSquare <> 0 };
(Width * Width) / ((12 * Middle) * Middle) -> Share / 12 { Middle <> 0 };
