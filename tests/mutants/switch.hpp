#pragma once
// Stands in the mutated copy of the tree only (tests/mutants): chooses the one change that is
// alive.

/// Number of the living mutant, from SHAPEID_MUTANT; zero: none, the program as it was written.
extern const int shapeid_living_mutant;

/// By number: this process came past the mutant.
extern unsigned char shapeid_passed_mutants[];

/// A comparison of two integers: allocates nothing, so that it may stand in `fast`.
inline bool shapeid_mutant(int number) noexcept {
  shapeid_passed_mutants[number] = 1;
  return number == shapeid_living_mutant;
}
