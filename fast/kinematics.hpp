// The forward pass that regressor, contacts and known links share: each link moved at most once a
// sample, and only if somebody asks.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// How a link moves, in its own axes, seen from the freely falling frame that coincides with the
/// base at this instant (docs/derivations/moving-frame.md). The point at x (link coordinates, m)
/// has the proper acceleration a + K x.
struct LinkMotion {
  Eigen::Vector3d omega;  ///< angular velocity, rad/s
  Eigen::Vector3d alpha;  ///< angular acceleration, rad/s^2
  Eigen::Vector3d a;      ///< proper acceleration of the link origin, m/s^2
  Eigen::Matrix3d K;      ///< S(alpha) + S(omega) S(omega), 1/s^2
};

/// Where a link is: x of the link is R x + p of the base.
struct LinkPose {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;  ///< m
};

/// What the links' frames do at one instant. Most joints of most robots turn about an axis of their
/// link's frame, and at zero that frame is parallel to its parent's: a vector then changes frames
/// with four multiplications instead of nine.
class Kinematics {
 public:
  /// Copies what it needs of the robot. The only call that allocates.
  explicit Kinematics(const Robot& robot);

  /// The sample that all later calls speak of. It must live until the next start. A sample for
  /// another number of joints is a defect of the caller: it ends the program where contracts are
  /// checked.
  void start(const Sample& sample) noexcept;

  [[nodiscard]] const LinkMotion& motion(int link) noexcept {
    const Link& l = links_[static_cast<std::size_t>(link)];
    return l.moved_in == sample_number_ ? l.motion : move(link);
  }
  [[nodiscard]] const LinkPose& pose(int link) noexcept {
    const Link& l = links_[static_cast<std::size_t>(link)];
    return l.posed_in == sample_number_ ? l.pose : place(link);
  }

  [[nodiscard]] int link_count() const noexcept { return static_cast<int>(links_.size()); }
  [[nodiscard]] int base_dof() const noexcept { return base_dof_; }

  /// Of any link but the root. The joint that carries it is number link - 1.
  [[nodiscard]] int parent(int link) const noexcept { return of(link).parent; }
  /// The joint is prismatic.
  [[nodiscard]] bool slides(int link) const noexcept { return of(link).slides; }
  /// Axis of the joint, link axes.
  [[nodiscard]] const Eigen::Vector3d& axis(int link) const noexcept { return of(link).axis; }
  /// Axis of the joint, base axes.
  [[nodiscard]] Eigen::Vector3d axis_in_base(int link) noexcept {
    return pose(link).R * of(link).axis;
  }

  /// A vector of the link's axes in its parent's axes, after motion(link) or pose(link).
  [[nodiscard]] Eigen::Vector3d up(int link, const Eigen::Vector3d& v) const noexcept {
    return of(link).up(v);
  }
  /// From the parent's origin to the link's, parent's axes, m; after motion(link) or pose(link).
  [[nodiscard]] const Eigen::Vector3d& arm(int link) const noexcept { return of(link).arm; }

 private:
  static constexpr int any = -1;  ///< of `about`

  struct Link {
    // Of the robot.
    int parent = 0;
    int about = any;     ///< number of the coordinate axis that is turned about, placement parallel
    double sense = 1.0;  ///< -1 if turned about minus that axis
    bool slides = false;
    Eigen::Vector3d axis;    ///< link's axes
    Eigen::Vector3d origin;  ///< of the joint in the parent's frame, m
    Eigen::Vector3d slide;   ///< parent's axes: what the arm grows by for each m
    /// Link's axes to parent's: still + cos(q) even + sin(q) odd (Rodrigues), unless `about` an
    /// axis.
    Eigen::Matrix3d still, even, odd;

    // Of the sample.
    std::uint64_t turned_in = 0, moved_in = 0, posed_in = 0;
    double cosine = 1.0, sine = 0.0;
    Eigen::Matrix3d turn;  ///< link's axes to parent's, unless `about` an axis
    Eigen::Vector3d arm;
    LinkMotion motion;
    LinkPose pose;

    /// Parent's axes to link's.
    [[nodiscard]] Eigen::Vector3d down(const Eigen::Vector3d& v) const noexcept;
    [[nodiscard]] Eigen::Vector3d up(const Eigen::Vector3d& v) const noexcept;
  };

  [[nodiscard]] const Link& of(int link) const noexcept {
    return links_[static_cast<std::size_t>(link)];
  }
  void turn(int number) noexcept;
  const LinkMotion& move(int number) noexcept;
  const LinkPose& place(int number) noexcept;

  int base_dof_;
  std::vector<Link> links_;
  const Sample* sample_ = nullptr;
  std::uint64_t sample_number_ = 0;
};

namespace internal {

/// v after the axes turned by (c, s) about axis k: written out, so that it stays in registers.
template <int k>
[[nodiscard]] inline Eigen::Vector3d turned_about(double c, double s,
                                                  const Eigen::Vector3d& v) noexcept {
  constexpr int i = (k + 1) % 3, j = (k + 2) % 3;
  Eigen::Vector3d w;
  w[k] = v[k];
  w[i] = c * v[i] + s * v[j];
  w[j] = c * v[j] - s * v[i];
  return w;
}

}  // namespace internal

inline Eigen::Vector3d Kinematics::Link::down(const Eigen::Vector3d& v) const noexcept {
  switch (about) {
    case 0:
      return internal::turned_about<0>(cosine, sine, v);
    case 1:
      return internal::turned_about<1>(cosine, sine, v);
    case 2:
      return internal::turned_about<2>(cosine, sine, v);
    default:
      return turn.transpose() * v;
  }
}

inline Eigen::Vector3d Kinematics::Link::up(const Eigen::Vector3d& v) const noexcept {
  switch (about) {
    case 0:
      return internal::turned_about<0>(cosine, -sine, v);
    case 1:
      return internal::turned_about<1>(cosine, -sine, v);
    case 2:
      return internal::turned_about<2>(cosine, -sine, v);
    default:
      return turn * v;
  }
}

}  // namespace shapeid::fast
