#include "shapeid/fast/many_links.hpp"

#include <algorithm>
#include <cstddef>

#include "shapeid/fast/triangle_products.hpp"

namespace shapeid::fast {

ManyLinks::ManyLinks(const ShapeColumns& columns)
    : columns_(&columns),
      qr_(Eigen::Index{10} * columns.links(),
          std::min(Eigen::Index{10} * columns.links(), Eigen::Index{columns.capacity()})),
      target_(Eigen::VectorXd::Zero(Eigen::Index{10} * columns.links())),
      correction_(target_) {
  passive_.reserve(static_cast<std::size_t>(target_.size()) + 1);
  ends_.resize(static_cast<std::size_t>(qr_.most_columns()));
}

void ManyLinks::start(const Eigen::MatrixXd& R) noexcept {
  R_ = &R;
  passive_.clear();
  sound_ = true;
  solved_ = false;
  qr_.start(right_hand_side(R));
}

/// R u_j at entering(k); returns where its zeros begin.
Eigen::Index ManyLinks::write(int j, Eigen::Index k) noexcept {
  const Eigen::Index end = Eigen::Index{10} * (columns_->link(j) + 1);
  qr_.entering(k).head(end).setZero();
  add_column(*R_, columns_->link(j), columns_->column(j).data(), qr_.entering(k).data());
  return end;
}

ColumnQr::Push ManyLinks::push(int j) noexcept { return qr_.push(write(j, 0)); }

// An unsound set has fewer columns in its factorisation than passive shapes. It is no longer
// updated, for its places are others; shapes are only counted until start().
bool ManyLinks::enter(int j) noexcept {
  if (!sound_) {
    const bool has_room = passive_.size() < static_cast<std::size_t>(target_.size());
    if (has_room) passive_.push_back(j);
    return has_room;
  }
  ColumnQr::Push result = push(j);
  if (result == ColumnQr::Push::crowded) {
    rebuild();
    if (!sound_) return enter(j);
    result = push(j);
  }
  if (result != ColumnQr::Push::entered) return false;
  passive_.push_back(j);
  solved_ = false;
  return true;
}

// What does not enter with the others is asked alone: it may only have found no room.
std::size_t ManyLinks::enter_first(std::span<const int> shapes) noexcept {
  std::size_t entered = 0;
  while (sound_ && entered < shapes.size()) {
    entered += push_all(shapes.subspan(entered));
    if (entered == shapes.size() || !enter(shapes[entered])) return entered;
    ++entered;
  }
  return entered + PassiveSet::enter_first(shapes.subspan(entered));
}

/// As many as enter together.
std::size_t ManyLinks::push_all(std::span<const int> shapes) noexcept {
  const std::size_t count = std::min(shapes.size(), ends_.size());
  for (std::size_t k = 0; k < count; ++k) {
    ends_[k] = write(shapes[k], static_cast<Eigen::Index>(k));
  }
  const auto entered = static_cast<std::size_t>(qr_.push_all({ends_.data(), count}));
  passive_.insert(passive_.end(), shapes.begin(),
                  shapes.begin() + static_cast<std::ptrdiff_t>(entered));
  solved_ = false;
  return entered;
}

void ManyLinks::dependence(Eigen::VectorXd& coefficients) noexcept { qr_.dependence(coefficients); }

void ManyLinks::leave(int place) noexcept {
  passive_.erase(passive_.begin() + place);
  solved_ = false;
  if (sound_ && !qr_.remove(place)) rebuild();
}

void ManyLinks::rebuild() noexcept {
  qr_.start(right_hand_side(*R_));
  for (const int j : passive_) sound_ = push(j) == ColumnQr::Push::entered && sound_;
}

const Eigen::VectorXd& ManyLinks::target() noexcept {
  if (!solved_) qr_.solve(target_);
  solved_ = true;
  return target_;
}

void ManyLinks::refine(const Eigen::VectorXd& slopes) noexcept {
  for (std::size_t i = 0; i < passive_.size(); ++i) {
    const int j = passive_[i];
    correction_[static_cast<Eigen::Index>(i)] =
        columns_->column(j).dot(slopes.segment<10>(Eigen::Index{10} * columns_->link(j)));
  }
  qr_.solve_normal(correction_);
  target_.head(qr_.size()) += correction_.head(qr_.size());
}

}  // namespace shapeid::fast
