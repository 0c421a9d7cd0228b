#include "shapeid/fast/shape_columns.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace shapeid::fast {
namespace {

/// What a barred shape's price is lowered by. Prices lie in [-1, 1].
constexpr float barred = 1e30F;
/// And what no price reaches, unless products overflowed.
constexpr float no_price = 2.0F;

/// What rounding to single precision may do to a price: thirteen roundings (ten products, the two
/// operands, the scale) of terms whose sizes add up to one.
constexpr float uncertain = 13.0F / (1 << 24);

/// Kept away from zero, so that a shape which no row feels has the price zero and not NaN.
constexpr float smallest_scale = 1e-30F;

/// Of the largest price: what counts as almost as large.
constexpr float almost = 0.1F;

using Prices = Eigen::Array<float, 16, 1>;

struct Best {
  float price;
  std::size_t lane;
};

/// The largest price and its lane. The lane's number is written into the last four bits of its
/// price, which single precision cannot vouch for anyway: then one maximum finds both.
Best best_of(const Prices& prices) noexcept {
  Eigen::Array<std::uint32_t, 16, 1> bits;
  for (unsigned i = 0; i < 16; ++i) {
    bits[i] = (std::bit_cast<std::uint32_t>(prices[i]) & ~std::uint32_t{15}) | i;
  }
  Prices marked;
  for (unsigned i = 0; i < 16; ++i) marked[i] = std::bit_cast<float>(bits[i]);
  const float most = marked.maxCoeff();
  return {most, std::bit_cast<std::uint32_t>(most) & 15U};
}

}  // namespace

ShapeColumns::ShapeColumns(int links, int most_shapes)
    // Every link's last chunk may be almost empty.
    : chunks_(static_cast<std::size_t>(most_shapes / lanes + links)),
      slots_(static_cast<std::size_t>(most_shapes)),
      links_(static_cast<std::size_t>(most_shapes)),
      columns_(10, most_shapes),
      last_of_link_(static_cast<std::size_t>(links), -1),
      lengths_(Eigen::VectorXd::Ones(Eigen::Index{10} * links)) {
  uncertain_.reserve(chunks_.size());
  best_.reserve(chunks_.size());
  steep_ones_.reserve(chunks_.size() + 1);
}

void ShapeColumns::clear() noexcept {
  size_ = 0;
  used_chunks_ = 0;
  std::fill(last_of_link_.begin(), last_of_link_.end(), -1);
}

bool ShapeColumns::append(int link, const Column& u) noexcept {
  if (size_ == capacity()) return false;
  int& last = last_of_link_[static_cast<std::size_t>(link)];
  if (last < 0 || chunks_[static_cast<std::size_t>(last)].used == lanes) {
    last = used_chunks_++;
    Chunk& fresh = chunks_[static_cast<std::size_t>(last)];
    fresh.U.setZero();
    fresh.scale.setOnes();
    fresh.barrier.setConstant(barred);
    fresh.link = link;
    fresh.used = 0;
  }
  Chunk& chunk = chunks_[static_cast<std::size_t>(last)];
  const int lane = chunk.used++;
  chunk.shape[static_cast<std::size_t>(lane)] = size_;
  chunk.barrier[lane] = 0.0F;
  slots_[static_cast<std::size_t>(size_)] = {last, lane};
  links_[static_cast<std::size_t>(size_)] = link;
  write(size_++, u);
  return true;
}

void ShapeColumns::replace(int j, const Column& u) noexcept { write(j, u); }

void ShapeColumns::write(int j, const Column& u) noexcept {
  columns_.col(j) = u;
  const Slot& slot = slots_[static_cast<std::size_t>(j)];
  Chunk& chunk = chunks_[static_cast<std::size_t>(slot.chunk)];
  chunk.U.row(slot.lane) = u.transpose().cast<float>().array();
  const double size = u.cwiseAbs().dot(lengths_.segment<10>(Eigen::Index{10} * chunk.link));
  chunk.scale[slot.lane] = 1.0F / std::max(static_cast<float>(size), smallest_scale);
}

double ShapeColumns::price(int j, double slope) const noexcept {
  const Slot& slot = slots_[static_cast<std::size_t>(j)];
  const double scale = chunks_[static_cast<std::size_t>(slot.chunk)].scale[slot.lane];
  return unit_ > 0.0 ? slope * scale / unit_ : slope;
}

void ShapeColumns::set_scale(const Eigen::VectorXd& lengths, double length) noexcept {
  const double largest = lengths.size() > 0 ? lengths.maxCoeff() : 0.0;
  lengths_ = lengths * (largest > 0.0 ? 1.0 / largest : 1.0);
  unit_ = largest * length;
  for (int c = 0; c < used_chunks_; ++c) set_scale(chunks_[static_cast<std::size_t>(c)]);
}

void ShapeColumns::set_scale(Chunk& chunk) noexcept {
  const Eigen::Array<float, 10, 1> lengths =
      lengths_.segment<10>(Eigen::Index{10} * chunk.link).cast<float>();
  Prices size = Prices::Constant(smallest_scale);
  for (int i = 0; i < 10; ++i) size += chunk.U.col(i).abs() * lengths[i];
  chunk.scale = size.inverse();
}

void ShapeColumns::bar(int j, bool is_barred) noexcept {
  const Slot& slot = slots_[static_cast<std::size_t>(j)];
  chunks_[static_cast<std::size_t>(slot.chunk)].barrier[slot.lane] = is_barred ? barred : 0.0F;
}

void ShapeColumns::unbar_all() noexcept {
  for (int c = 0; c < used_chunks_; ++c) {
    Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
    chunk.barrier.head(chunk.used).setZero();
  }
}

int ShapeColumns::steepest(const Eigen::VectorXd& g, double threshold) noexcept {
  const double unit = unit_ > 0.0 ? 1.0 / unit_ : 1.0;
  steepest_ = -1;
  best_.clear();
  // As many passive shapes as rows: nothing is left to gain.
  if (threshold >= 0.0 && g.isZero(0.0)) return -1;
  float most = uncertain;
  uncertain_.clear();
  for (int c = 0; c < used_chunks_; ++c) {
    const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
    const Eigen::Array<float, 10, 1> gl =
        (unit * g.segment<10>(Eigen::Index{10} * chunk.link)).cast<float>();
    // Two sums, so that one addition need not wait for the other.
    Prices even = chunk.U.col(0) * gl[0], odd = chunk.U.col(1) * gl[1];
    for (int i = 2; i < 10; i += 2) {
      even += chunk.U.col(i) * gl[i];
      odd += chunk.U.col(i + 1) * gl[i + 1];
    }
    const Best here = best_of((even + odd) * chunk.scale - chunk.barrier);
    if (!(here.price <= no_price)) {
      // A float overflowed, and may stand above the barrier: double decides.
      uncertain_.push_back(c);
      continue;
    }
    if (here.price > -uncertain) uncertain_.push_back(c);
    const int shape = chunk.shape[here.lane];
    best_.push_back({shape, here.price});
    if (here.price > most) {
      most = here.price;
      steepest_ = shape;
    }
  }
  if (steepest_ < 0 && !uncertain_.empty()) {
    best_.clear();
    steepest_ = steepest_in_double(g, threshold);
  }
  return steepest_;
}

const std::vector<int>& ShapeColumns::steep_ones(Among among) noexcept {
  steep_ones_.clear();
  if (steepest_ < 0) return steep_ones_;
  steep_ones_.push_back(steepest_);
  float most = 0.0F;
  for (const Priced& best : best_) most = std::max(most, best.price);
  for (const Priced& best : best_) {
    if (best.price < almost * most || best.shape == steepest_) continue;
    const bool beaten =
        among == Among::links && std::any_of(best_.begin(), best_.end(), [&](const Priced& other) {
          return link(other.shape) == link(best.shape) && other.price > best.price;
        });
    if (!beaten) steep_ones_.push_back(best.shape);
  }
  return steep_ones_;
}

int ShapeColumns::steepest_in_double(const Eigen::VectorXd& g, double threshold) const noexcept {
  int best = -1;
  double most = threshold;
  for (const int c : uncertain_) {
    const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
    for (int lane = 0; lane < chunk.used; ++lane) {
      if (chunk.barrier[lane] > 0.0F) continue;
      const int j = chunk.shape[static_cast<std::size_t>(lane)];
      const double slope = columns_.col(j).dot(g.segment<10>(Eigen::Index{10} * chunk.link));
      if (price(j, slope) > most) {
        most = price(j, slope);
        best = j;
      }
    }
  }
  return best;
}

}  // namespace shapeid::fast
