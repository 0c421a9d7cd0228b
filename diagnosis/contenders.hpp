// The candidates of a selection as terms of its fits: in sets, side by side, by promise.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis {

/// Candidates by their numbers.
using Chosen = std::vector<std::size_t>;

struct Shortlist {
  Chosen listed;  ///< the most promising first
  Chosen hidden;  ///< the data can hardly tell them from masses and what is chosen
};

/// All arguments of the constructor must outlive this.
class Contenders {
 public:
  /// `contained_too`: what the data cannot tell from masses is listed as well.
  Contenders(const BlockFits& fits, const Term& masses, const std::vector<Candidate>& candidates,
             bool contained_too = false)
      : fits_(fits), masses_(masses), candidates_(candidates), contained_too_(contained_too) {}

  [[nodiscard]] const Candidate& operator[](std::size_t k) const { return candidates_[k]; }
  /// Of the effects that are usually fitted, those that always act, at each place.
  [[nodiscard]] Chosen usual() const;
  /// Whether the data cannot tell k from masses and the others.
  [[nodiscard]] bool is_contained(std::size_t k, const Chosen& others) const;
  /// Parameters of all together; groups have none of their own.
  [[nodiscard]] double parameters() const;

  /// Masses and what is chosen.
  [[nodiscard]] std::vector<Term> terms(const Chosen& chosen) const;
  /// Likewise, and candidate k last.
  [[nodiscard]] std::vector<Term> terms(const Chosen& chosen, std::size_t k) const;
  /// Columns of the masses.
  [[nodiscard]] Eigen::Index first_column() const { return std::ssize(masses_.columns); }
  /// Of a fit whose last term is candidate k the part of k.
  [[nodiscard]] Fit last_of(std::size_t k, const Fit& fit) const;

  /// Candidate k, or a member of the group that it is, is one of these.
  [[nodiscard]] bool is_among(std::size_t k, const Chosen& chosen) const;
  /// Likewise, or another onset of one of these.
  [[nodiscard]] bool is_taken(std::size_t k, const Chosen& chosen) const;
  [[nodiscard]] bool same_place(std::size_t k, std::size_t other) const;
  /// The same effect at the same site, whenever it came.
  [[nodiscard]] bool same_law(std::size_t k, std::size_t other) const;
  /// The same law at other times, those of which are candidates; of each time one.
  [[nodiscard]] Chosen of_other_times(std::size_t k) const;

  /// Parameters, those of shape and transformations counted on top.
  [[nodiscard]] std::size_t cost(std::size_t k) const;
  [[nodiscard]] std::size_t cost(const Chosen& chosen) const;
  /// Findings, and numbers in them: what is smaller is simpler.
  [[nodiscard]] std::pair<std::size_t, std::size_t> extent(const Chosen& chosen) const {
    return {chosen.size(), cost(chosen)};
  }

  /// The most promising beside what is chosen, without `excluded` and what is only a rival.
  [[nodiscard]] Shortlist shortlist(const Chosen& chosen, int length,
                                    const Chosen& excluded = {}) const;
  /// Likewise, with those.
  [[nodiscard]] Chosen rivals(const Chosen& chosen, int length) const;

 private:
  [[nodiscard]] Shortlist most_promising(const Chosen& open, const Chosen& chosen,
                                         int length) const;
  [[nodiscard]] bool any_single(std::size_t k,
                                const std::function<bool(std::size_t)>& condition) const;

  const BlockFits& fits_;
  const Term& masses_;
  const std::vector<Candidate>& candidates_;
  bool contained_too_;
};

/// Numbers `from` and the following n of a fit.
[[nodiscard]] Fit part_of(const Fit& fit, Eigen::Index from, Eigen::Index n);

}  // namespace shapeid::diagnosis
