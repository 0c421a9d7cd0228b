// The reader of Coq files sees what it is there to see.
#include "theorems.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Theorems, AreFoundWithTheClaimAboveThem) {
  const std::string text =
      "(** A file. Claim C1. *)\n\n"
      "  (** Claim C7. Two\n      lines. *)\n  Theorem first_of_all x : x = x.\n"
      "  Lemma not_a_claim : True.\n"
      "  (** Claim C2. Of a lemma. *)\n  Lemma other : True.\n"
      "  Theorem without : True.\n"
      "  (** No Claim C3. in the beginning. *)\n  Theorem late : True.\n";
  const std::map<std::string, std::string> expected = {
      {"file.first_of_all", "C7"}, {"file.without", ""}, {"file.late", ""}};
  EXPECT_EQ(theorems("file", text), expected);
}

TEST(Theorems, WhatIsTakenWithoutProofIsSeen) {
  EXPECT_TRUE(unproved("Lemma x : True. Proof. trivial. Qed. (* an axiom, admitted *)").empty());
  EXPECT_EQ(unproved("Axiom a : False.\nLemma b : a.\nProof. admit. Admitted.\nParameter c : nat."),
            (std::vector<std::string>{"Axiom", "admit", "Admitted", "Parameter"}));
  EXPECT_EQ(unproved("Unset Guard Checking. #[bypass_check(guard)] Fixpoint"),
            (std::vector<std::string>{"Unset Guard Checking", "bypass_check"}));
}

}  // namespace
