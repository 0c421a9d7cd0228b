// What a window weighs that stands out, and one that says nothing of noise.
#include "shapeid/app/track_noise.hpp"

#include <gtest/gtest.h>

namespace shapeid::app {
namespace {

TEST(TrackNoise, AWindowThatSaysNothingIsAsNoisyAsUsual) {
  TrackNoise noise(4);
  noise.suppose(100.0);
  EXPECT_EQ(noise.usual(), 100.0);
  EXPECT_EQ(noise.last(), 100.0);
  noise.suppose(50.0);
  EXPECT_EQ(noise.last(), 50.0);

  // What was supposed is forgotten when something is learned, and is in no mean.
  noise.learn(2.0);
  EXPECT_EQ(noise.usual(), 2.0);
  noise.suppose(100.0);
  noise.learn(4.0);
  EXPECT_EQ(noise.usual(), 3.0);
  for (int k = 0; k < 10; ++k) noise.suppose(0.0);
  EXPECT_EQ(noise.usual(), 3.0);
  EXPECT_EQ(noise.last(), 3.0);

  // One that stands out does not decide for the next.
  noise.learn(1000.0);
  EXPECT_EQ(noise.last(), 1000.0);
  noise.suppose(100.0);
  EXPECT_EQ(noise.last(), noise.usual());
}

}  // namespace
}  // namespace shapeid::app
