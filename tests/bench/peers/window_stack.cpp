#include "shapeid/tests/bench/peers/window_stack.hpp"

#include <algorithm>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/bench/peers/mass_peer.hpp"
#ifdef SHAPEID_PINOCCHIO
#include <Eigen/QR>

#include "shapeid/tests/bench/peers/pinocchio_robot.hpp"
#endif

namespace shapeid::bench {
namespace {

class ReferenceStack final : public WindowStack {
 public:
  ReferenceStack(const Robot& robot, const BodyModel& model)
      : model_(model),
        window_(robot, model, ContactTreatment::project, Eigen::VectorXd::Ones(robot.dof())) {}

  void take(const std::vector<Sample>& samples) override { samples_ = samples; }

  bool solve(std::size_t from, std::size_t count, Eigen::VectorXd& m) override {
    window_.clear();
    for (std::size_t i = from; i < from + count; ++i) window_.add(samples_[i]);
    m = reference::solve_masses(window_.problem(model_)).m;
    return true;
  }

 private:
  BodyModel model_;
  reference::Window window_;
  std::vector<Sample> samples_;
};

#ifdef SHAPEID_PINOCCHIO

std::unique_ptr<MassPeer> make_peer(const std::string& name) {
  const auto& all = mass_peers();
  const auto kind =
      std::find_if(all.begin(), all.end(), [&name](const PeerKind& k) { return k.name == name; });
  return kind == all.end() ? nullptr : kind->make();
}

/// What the two stacks of other people's parts share.
class PinocchioStack : public WindowStack {
 public:
  PinocchioStack(const Robot& robot, const BodyModel& model)
      : robot_(robot, model.known),
        dof_(robot.dof()),
        joints_(robot.joint_count()),
        U_(shape_columns(model)) {}

  void take(const std::vector<Sample>& samples) override {
    for (const Sample& s : samples) {
      Input input{PinocchioRobot::motion(s), s.tau, {}};
      for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
        if (s.in_contact[c]) input.contacts.push_back(c);
      }
      inputs_.push_back(std::move(input));
    }
  }

 protected:
  struct Input {
    PinocchioMotion motion;
    Eigen::VectorXd tau;
    std::vector<std::size_t> contacts;
  };

  /// J^T of the standing feet, dof x 3 feet.
  void transposed_jacobian(const Input& input, Eigen::MatrixXd& JT) {
    JT.resize(dof_, 3 * static_cast<Eigen::Index>(input.contacts.size()));
    Eigen::Index column = 0;
    for (const std::size_t contact : input.contacts) {
      JT.middleCols<3>(column) = robot_.contact_jacobian(input.motion, contact).transpose();
      column += 3;
    }
  }

  PinocchioRobot robot_;
  Eigen::Index dof_, joints_;
  Eigen::MatrixXd U_;  ///< in our order
  std::vector<Input> inputs_;
};

/// As published: the full regressor, known links moved over with it, Q formed and Q2^T applied, the
/// normal equations, qpOASES (its default options: those that are always right here).
class PublishedStack final : public PinocchioStack {
 public:
  PublishedStack(const Robot& robot, const BodyModel& model)
      : PinocchioStack(robot, model), known_(model.known) {}

  bool solve(std::size_t from, std::size_t count, Eigen::VectorXd& m) override {
    Y_.resize(dof_ * static_cast<Eigen::Index>(count), 10);
    F_.resize(Y_.rows());
    Eigen::Index row = 0;
    for (std::size_t i = from; i < from + count; ++i) {
      const Input& input = inputs_[i];
      regressor_ = robot_.regressor(input.motion);
      to_our_order(regressor_);
      force_.setZero(dof_);
      force_.tail(joints_) = input.tau;
      force_.noalias() -= regressor_ * known_;
      transposed_jacobian(input, JT_);
      qr_.compute(JT_);
      Q_ = qr_.householderQ();
      const auto Q2 = Q_.rightCols(dof_ - JT_.cols());
      Y_.middleRows(row, Q2.cols()).noalias() = Q2.transpose() * regressor_.leftCols<10>();
      F_.segment(row, Q2.cols()).noalias() = Q2.transpose() * force_;
      row += Q2.cols();
    }
    prepared_.A.noalias() = Y_.topRows(row) * U_;
    prepared_.b = F_.head(row);
    prepared_.H.noalias() = prepared_.A.transpose() * prepared_.A;
    prepared_.g.noalias() = -(prepared_.A.transpose() * prepared_.b);
    return solver_->solve(unused_, prepared_, nullptr, m);
  }

 private:
  Eigen::VectorXd known_;
  Eigen::MatrixXd regressor_, JT_, Q_, Y_;
  Eigen::VectorXd force_, F_;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
  DenseProblem unused_;
  Prepared prepared_;
  std::unique_ptr<MassPeer> solver_ = make_peer("qpoases/default");
};

/// The best parts of others: the base's rows alone, recursive Newton-Euler for the known links, a
/// QR of fixed size whose reflections are applied and not formed, the window compressed by QR,
/// Lawson-Hanson.
class BestMix final : public PinocchioStack {
 public:
  using PinocchioStack::PinocchioStack;

  bool solve(std::size_t from, std::size_t count, Eigen::VectorXd& m) override {
    rows_.resize(dof_ * static_cast<Eigen::Index>(count), 11);
    Eigen::Index row = 0;
    for (std::size_t i = from; i < from + count; ++i) {
      const Input& input = inputs_[i];
      sample_.setZero();
      sample_.topLeftCorner<6, 10>() = PinocchioRobot::base_regressor(input.motion);
      sample_.col(6).swap(sample_.col(7));
      sample_.col(10) = -robot_.inverse_dynamics(input.motion);
      sample_.col(10).tail(joints_) += input.tau;
      transposed_jacobian(input, JT_);
      if (JT_.cols() == two_feet) {
        fixed_qr_.compute(JT_);
        sample_.applyOnTheLeft(fixed_qr_.householderQ().adjoint());
      } else {
        qr_.compute(JT_);
        sample_.applyOnTheLeft(qr_.householderQ().adjoint());
      }
      const Eigen::Index free = dof_ - JT_.cols();
      rows_.middleRows(row, free) = sample_.bottomRows(free);
      row += free;
    }
    compression_.compute(rows_.topRows(row));
    const auto R = compression_.matrixQR().topLeftCorner<10, 11>().triangularView<Eigen::Upper>();
    triangle_ = R;
    prepared_.A = triangle_.leftCols<10>().lazyProduct(U_);
    prepared_.b = triangle_.col(10);
    return solver_->solve(unused_, prepared_, nullptr, m);
  }

 private:
  static constexpr Eigen::Index size = 18, two_feet = 6;

  Eigen::Matrix<double, size, 11> sample_;
  Eigen::Matrix<double, 10, 11> triangle_;
  Eigen::MatrixXd JT_, rows_;
  Eigen::HouseholderQR<Eigen::Matrix<double, size, two_feet>> fixed_qr_;
  Eigen::HouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 11>> compression_;
  DenseProblem unused_;
  Prepared prepared_;
  std::unique_ptr<MassPeer> solver_ = make_peer("lawson_hanson");
};
#endif

template <typename Stack>
StackKind kind(const std::string& name) {
  return {name, [](const Robot& robot, const BodyModel& model) {
            return std::make_unique<Stack>(robot, model);
          }};
}

}  // namespace

std::vector<StackKind> window_stacks() {
  std::vector<StackKind> stacks;
  add_fast(stacks);
  stacks.push_back(kind<ReferenceStack>("reference"));
#ifdef SHAPEID_PINOCCHIO
  stacks.push_back(kind<BestMix>("best_mix"));
#ifdef SHAPEID_QPOASES
  stacks.push_back(kind<PublishedStack>("published"));
#endif
#endif
  return stacks;
}

}  // namespace shapeid::bench
