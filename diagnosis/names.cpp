#include "shapeid/diagnosis/names.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/contact_flags.hpp"
#include "shapeid/diagnosis/contest.hpp"
#include "shapeid/diagnosis/placebo.hpp"

namespace shapeid::diagnosis {
namespace {

// Standard errors by which a ripple must predict better than the best over another joint.
constexpr double better_t = 2.0;

class Names {
 public:
  explicit Names(LoopState& state) : state_(state), found_(state.result.found) {}

  void question() {
    const Questions asked = questions(true);
    const std::size_t effects = asked.effects();
    const Eigen::VectorXd errors = asked.fits.held_out(asked.terms);
    const double error = errors.sum();
    const double placebo = best_placebo(asked.fits, asked.terms, effects, asked.first_ripple);
    state_.result.placebo = placebo / error;
    Eigen::VectorXd own_gain(static_cast<Eigen::Index>(effects));
    for (std::size_t k = 0; k < effects; ++k) {
      own_gain[static_cast<Eigen::Index>(k)] = error * worth(found_[k].gain);
    }
    const auto varies = variations(asked.fits, asked.terms, own_gain);
    const Contest against = compete(asked, errors);
    state_.result.strangers = against.strangers;
    for (std::size_t k = 0; k < effects; ++k) {
      const double own = own_gain[static_cast<Eigen::Index>(k)];
      found_[k].varies = varies[k];
      found_[k].displaced = against.displaced[k];
      found_[k].drowned = own < placebo;
      found_[k].any_period = is_any_ripple(asked, k, errors);
      found_[k].rival = against.rivals[k];
      found_[k].pulls = found_[k].effect.effect->id == "contact_undeclared" &&
                        !pushes(state_.log, found_[k].effect.value);
      if (!asked.own_term[k] && !found_[k].displaced) contest_transformation(k, errors, own);
    }
    for (Found& f : found_) {
      f.beside_unknown = is_beside_unknown(state_.robot, state_.result, f);
    }
  }

 private:
  /// About the present effects. Ripples of one joint over another's position are among the placebos
  /// if they are asked for.
  [[nodiscard]] Questions questions(bool with_ripples) {
    std::vector<AppliedEffect> all = state_.result.model.effects;
    const std::size_t effects = all.size();
    const auto append = [&](const std::vector<AppliedEffect>& more) {
      all.insert(all.end(), more.begin(), more.end());
      return all.size();
    };
    const std::size_t first_ripple = append(placebos(state_.robot));
    for (std::size_t k = 0; with_ripples && k < effects; ++k) {
      if (!is_ripple(all[k])) continue;
      RichModel without = state_.result.model;
      without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(k));
      // One that went is in the reference log alone.
      const Rest rest = all[k].acts_in_log() ? Rest{state_.log, state_.left_by(without)}
                                             : *state_.rest_of_reference(without);
      append(ripple_placebos(state_.robot, rest.log, rest.left, all[k].site));
    }
    const std::size_t first_carrier = all.size();
    append(carriers(state_.robot, state_.result.model.effects));
    append(ripple_carriers(state_.robot, state_.log, state_.left_by(state_.rigid),
                           state_.left_by(state_.result.model)));
    std::vector<Modulation> products = modulations(state_.robot, state_.result.model.effects);
    for (const Modulation& m : modulated_carriers(state_.log, all, first_carrier, all.size())) {
      products.push_back(m);
    }
    BlockFits fits = state_.tallied(all, products);
    Questions asked{std::move(fits), {}, {}, first_ripple, first_carrier, {}};
    asked.terms = state_.terms_of_model(asked.fits, effects);
    std::size_t next = 1;  // after the masses
    for (std::size_t k = 0; k < all.size(); ++k) {
      asked.choices.push_back(k < first_carrier ? 1.0 : periods_told_apart(state_.log, all[k]));
      if (k >= effects) continue;
      const bool column = !all[k].effect->transform.any();
      asked.own_term.push_back(column ? std::optional(next++) : std::nullopt);
    }
    return asked;
  }

  /// Names against laws without one. Transformations are within the masses' term and cannot be left
  /// out there: whether one stranger does for them and others is asked of a model without any.
  [[nodiscard]] Contest compete(const Questions& asked, const Eigen::VectorXd& named) {
    const auto transforms = [](const Found& f) { return f.effect.effect->transform.any(); };
    const auto taken_out =
        static_cast<std::size_t>(std::count_if(found_.begin(), found_.end(), transforms));
    if (taken_out > 0 && found_.size() > 1) {
      const std::vector<Found> all = found_;
      std::erase_if(found_, transforms);
      state_.collect_effects();
      const std::optional<Contest> fewer = contest_if_fewer(questions(false), named, taken_out);
      found_ = all;
      state_.collect_effects();
      if (fewer) {
        Contest result{fewer->strangers, {}, {}};
        std::size_t column = 0;
        for (const Found& f : all) {
          const std::size_t own = transforms(f) ? all.size() : column++;
          result.displaced.push_back(transforms(f) || fewer->displaced[own]);
          result.rivals.push_back(transforms(f) ? std::nullopt : fewer->rivals[own]);
        }
        return result;
      }
    }
    return contest(asked);
  }

  /// Whether a law without a name predicts better than an applied transformation: the sums are made
  /// once more without it.
  void contest_transformation(std::size_t k, const Eigen::VectorXd& named, double own_gain) {
    const std::vector<Found> all = found_;
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(k));
    state_.collect_effects();
    const std::optional<BestStranger> instead = best_stranger(questions(false));
    found_ = all;
    state_.collect_effects();
    if (!instead) return;
    found_[k].displaced = takes_the_place(named, instead->error, own_gain);
    if (instead->error.sum() < named.sum()) found_[k].rival = instead->stranger;
  }

  /// Whether a ripple is worth no more, within chance, than the best over another joint's position,
  /// sought likewise. A period that was sought on all blocks fits each of them: what that is worth
  /// held-out errors do not tell.
  [[nodiscard]] bool is_any_ripple(const Questions& asked, std::size_t k,
                                   const Eigen::VectorXd& named) const {
    const Tally& tally = asked.fits.tally();
    if (!is_ripple(found_[k].effect)) return false;
    for (std::size_t p = asked.first_ripple; p < asked.first_carrier; ++p) {
      if (joint_of_placebo(state_.robot, tally.hypotheses[p]) != found_[k].effect.site) continue;
      std::vector<Term> instead = asked.terms;
      instead[*asked.own_term[k]].columns = {tally.first[p], tally.first[p] + 1};
      if (!(gain_of(asked.fits.held_out(instead), named).t > better_t)) return true;
    }
    return false;
  }

  LoopState& state_;
  std::vector<Found>& found_;
};

}  // namespace

bool is_beside_unknown(const Robot& robot, const LoopResult& loop, const Found& f) {
  const std::vector<bool> reach = reach_of(robot, f.effect);
  double unknown = 0.0;
  for (const Stranger& s : loop.strangers) {
    if (reach[static_cast<std::size_t>(s.law.joint)]) unknown += worth(s.gain);
  }
  for (const Found& other : loop.found) {
    if (!other.varies || other.displaced || &other == &f) continue;
    const std::vector<bool> its = reach_of(robot, other.effect);
    const bool same = std::inner_product(its.begin(), its.end(), reach.begin(), false,
                                         std::logical_or<>(), std::logical_and<>());
    if (same) unknown += worth(other.gain);
  }
  return worth(f.gain) < unknown;
}

void question_names(LoopState& state) { Names(state).question(); }

}  // namespace shapeid::diagnosis
