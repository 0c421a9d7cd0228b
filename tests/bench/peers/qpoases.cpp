// qpOASES 3.2: bounds only (QProblemB), its three sets of options, cold, warm (initial guess of
// masses and bounds) and hotstarted with new matrices (SQProblem, which alone can do that).
#include <qpOASES.hpp>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

enum class OptionSet { standard, reliable, mpc };

qpOASES::Options options_of(OptionSet set) {
  qpOASES::Options options;
  if (set == OptionSet::standard) options.setToDefault();
  if (set == OptionSet::reliable) options.setToReliable();
  if (set == OptionSet::mpc) options.setToMPC();
  options.printLevel = qpOASES::PL_NONE;
  return options;
}

/// Recalculations of the working set, far more than any problem here should need.
qpOASES::int_t most_changes(Eigen::Index shapes) {
  return static_cast<qpOASES::int_t>(10 * shapes + 100);
}

class QpOases final : public MassPeer {
 public:
  explicit QpOases(OptionSet set) : set_(set) {}

  [[nodiscard]] Form form() const override { return Form::normal; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    const Eigen::Index n = prepared.H.cols();
    resize(n);
    qpOASES::int_t changes = most_changes(n);
    qpOASES::returnValue outcome = qpOASES::RET_INIT_FAILED;
    if (warm == nullptr) {
      solver_->reset();
      outcome =
          solver_->init(prepared.H.data(), prepared.g.data(), zeros_.data(), nullptr, changes);
    } else {
      qpOASES::Bounds guess(static_cast<qpOASES::int_t>(n));
      for (Eigen::Index j = 0; j < n; ++j)
        guess.setupBound(static_cast<qpOASES::int_t>(j),
                         (*warm)[j] > 0.0 ? qpOASES::ST_INACTIVE : qpOASES::ST_LOWER);
      solver_->reset();
      outcome = solver_->init(prepared.H.data(), prepared.g.data(), zeros_.data(), nullptr, changes,
                              nullptr, warm->data(), nullptr, &guess);
    }
    m.resize(n);
    return solver_->getPrimalSolution(m.data()) == qpOASES::SUCCESSFUL_RETURN &&
           outcome == qpOASES::SUCCESSFUL_RETURN;
  }

 private:
  void resize(Eigen::Index n) {
    if (zeros_.size() == n) return;
    zeros_ = Eigen::VectorXd::Zero(n);
    solver_ = std::make_unique<qpOASES::QProblemB>(static_cast<qpOASES::int_t>(n));
    solver_->setOptions(options_of(set_));
  }

  OptionSet set_;
  Eigen::VectorXd zeros_;
  std::unique_ptr<qpOASES::QProblemB> solver_;
};

/// Hotstart with new H and g: of the classes, SQProblem is the one that has it.
class QpOasesHotstart final : public MassPeer {
 public:
  explicit QpOasesHotstart(OptionSet set) : set_(set) {}

  [[nodiscard]] Form form() const override { return Form::normal; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd* warm,
             Eigen::VectorXd& m) override {
    const Eigen::Index n = prepared.H.cols();
    const bool resized = resize(n);
    qpOASES::int_t changes = most_changes(n);
    qpOASES::returnValue outcome = qpOASES::RET_INIT_FAILED;
    if (warm == nullptr || resized || !solved_) {
      solver_->reset();
      outcome = solver_->init(prepared.H.data(), prepared.g.data(), nullptr, zeros_.data(), nullptr,
                              nullptr, nullptr, changes);
    } else {
      outcome = solver_->hotstart(prepared.H.data(), prepared.g.data(), nullptr, zeros_.data(),
                                  nullptr, nullptr, nullptr, changes);
    }
    m.resize(n);
    solved_ = solver_->getPrimalSolution(m.data()) == qpOASES::SUCCESSFUL_RETURN &&
              outcome == qpOASES::SUCCESSFUL_RETURN;
    return solved_;
  }

 private:
  bool resize(Eigen::Index n) {
    if (zeros_.size() == n) return false;
    zeros_ = Eigen::VectorXd::Zero(n);
    solver_ = std::make_unique<qpOASES::SQProblem>(static_cast<qpOASES::int_t>(n), 0);
    solver_->setOptions(options_of(set_));
    return true;
  }

  OptionSet set_;
  Eigen::VectorXd zeros_;
  std::unique_ptr<qpOASES::SQProblem> solver_;
  bool solved_ = false;
};

}  // namespace

void add_qpoases(std::vector<PeerKind>& peers) {
  const std::vector<std::pair<OptionSet, std::string>> sets = {
      {OptionSet::standard, "default"}, {OptionSet::reliable, "reliable"}, {OptionSet::mpc, "mpc"}};
  for (const auto& [set, name] : sets) {
    peers.push_back({"qpoases/" + name, false, [s = set] { return std::make_unique<QpOases>(s); }});
    peers.push_back(
        {"qpoases/" + name + "/warm", true, [s = set] { return std::make_unique<QpOases>(s); }});
    peers.push_back({"qpoases/" + name + "/hotstart", true,
                     [s = set] { return std::make_unique<QpOasesHotstart>(s); }});
  }
}

}  // namespace shapeid::bench
