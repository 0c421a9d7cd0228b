#include "shapeid/fast/shape_columns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {
namespace {

/// Kept away from zero, so that a shape which no row feels has the price zero and not NaN.
constexpr float smallest_scale = 1e-30F;

/// Of the largest price: what counts as almost as large. With lambda any shape may enter, and one
/// that must leave again costs more than one that waits.
constexpr float almost_on_links = 0.1F, almost = 0.3F;

using Ten = Eigen::Array<float, 10, 1>;

/// 1 / sum_i |u_i| sizes_i of each of sixteen shapes.
[[gnu::always_inline]] inline void inverse_sizes(const float* U, const float* sizes,
                                                 Eight* inverse) noexcept {
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    Eight sum = Eight{} + smallest_scale;
    for (std::ptrdiff_t i = 0; i < 10; ++i) {
      Eight u;
      load(U + 16 * i + 8 * p, u);
      take_sign(u);
      sum += u * sizes[i];
    }
    inverse[p] = 1.0F / sum;
  }
}

/// Prices of sixteen shapes by their lengths.
SHAPEID_WIDE Best price_by_lengths(PriceChunk& chunk, const float* g) noexcept {
  return price(chunk, g);
}

/// Of one shape in double.
struct Asked {
  double slope, terms;  ///< u . g, and the same of absolute values
};

/// Of the shapes of a chunk that are not barred and whose last price exceeds `below`, under which
/// none is above the threshold; `asked` has an entry a lane. Returns a bit a lane.
SHAPEID_WIDE unsigned ask(const PriceChunk& chunk, const double* columns, const double* g,
                          float below, Asked* asked) noexcept {
  Dozen b;
  load_ten(g, b);
  unsigned lanes = 0;
  for (int lane = 0; lane < chunk.used; ++lane) {
    if (chunk.barrier.data()[lane] > 0.0F || chunk.last.data()[lane] <= below) continue;
    lanes |= 1U << lane;
    Dozen a;
    load_ten(columns + std::ptrdiff_t{10} * chunk.shape[static_cast<std::size_t>(lane)], a);
    Four sum = {}, sizes = {};
    for (std::size_t p = 0; p < 3; ++p) {
      Four product = a.part[p] * b.part[p];
      sum += product;
      take_sign(product);
      sizes += product;
    }
    asked[lane] = {(sum[0] + sum[2]) + (sum[1] + sum[3]),
                   (sizes[0] + sizes[2]) + (sizes[1] + sizes[3])};
  }
  return lanes;
}

/// And by their own terms, into `prices`. `by_length`: what slopes are multiplied by first for the
/// former.
SHAPEID_WIDE void price_by_both(const float* U, const float* g, const float* scale,
                                const float* barrier, float by_length, float* prices,
                                Best& by_lengths, Best& by_terms) noexcept {
  Eight slopes[2], terms[2], here[2];
  float sizes[10];
  for (int i = 0; i < 10; ++i) sizes[i] = std::abs(g[i]);
  slopes_of(U, g, slopes);
  inverse_sizes(U, sizes, terms);
  for (std::ptrdiff_t p = 0; p < 2; ++p) {
    Eight factor, barred_by;
    load(scale + 8 * p, factor);
    load(barrier + 8 * p, barred_by);
    here[p] = by_length * slopes[p] * factor - barred_by;
    terms[p] = slopes[p] * terms[p] - barred_by;
    store(terms[p], prices + 8 * p);
  }
  by_lengths = best_of(here);
  by_terms = best_of(terms);
}

/// What slopes are multiplied by.
SHAPEID_WIDE void scales(const float* U, const float* sizes, float* scale) noexcept {
  Eight inverse[2];
  inverse_sizes(U, sizes, inverse);
  for (std::ptrdiff_t p = 0; p < 2; ++p) store(inverse[p], scale + 8 * p);
}

}  // namespace

ShapeColumns::ShapeColumns(int links, int most_shapes)
    // Every link's last chunk may be almost empty.
    : chunks_(static_cast<std::size_t>(most_shapes / lanes + links)),
      slots_(static_cast<std::size_t>(most_shapes)),
      links_(static_cast<std::size_t>(most_shapes)),
      columns_(10, most_shapes),
      last_of_link_(static_cast<std::size_t>(links), -1),
      best_of_link_(static_cast<std::size_t>(links)),
      lengths_(Eigen::VectorXd::Ones(Eigen::Index{10} * links)) {
  uncertain_.reserve(chunks_.size());
  best_.reserve(std::max(chunks_.size(), slots_.size()));
  best_by_terms_.reserve(best_.capacity());  // the two are swapped
  steep_ones_.reserve(best_.capacity() + 1);
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
    PriceChunk& fresh = chunks_[static_cast<std::size_t>(last)];
    fresh.U.setZero();
    fresh.scale.setOnes();
    fresh.barrier.setConstant(barred);
    fresh.link = link;
    fresh.used = 0;
    fresh.is_behind = false;
  }
  PriceChunk& chunk = chunks_[static_cast<std::size_t>(last)];
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
  PriceChunk& chunk = chunks_[static_cast<std::size_t>(slot.chunk)];
  if (!has_scale_) {
    chunk.is_behind = true;
    return;
  }
  const double* lengths = lengths_.data() + std::ptrdiff_t{10} * chunk.link;
  double even = 0.0, odd = 0.0;
  for (int i = 0; i < 10; i += 2) {
    even += std::abs(u[i]) * lengths[i];
    odd += std::abs(u[i + 1]) * lengths[i + 1];
  }
  write_lane(chunk, slot.lane, u.data());
  chunk.scale[slot.lane] = 1.0F / std::max(static_cast<float>(even + odd), smallest_scale);
}

void ShapeColumns::write_lane(PriceChunk& chunk, int lane, const double* u) noexcept {
  float* entries = chunk.U.data() + lane;
  for (int i = 0; i < 10; ++i) entries[std::ptrdiff_t{lanes} * i] = static_cast<float>(u[i]);
}

void ShapeColumns::set_scale(const Eigen::VectorXd& lengths, double length) noexcept {
  largest_ = lengths.size() > 0 ? lengths.maxCoeff() : 0.0;
  lengths_ = lengths * (largest_ > 0.0 ? 1.0 / largest_ : 1.0);
  unit_ = largest_ * length;
  inverse_unit_ = unit_ > 0.0 ? 1.0 / unit_ : 1.0;
  has_scale_ = true;
  for (int c = 0; c < used_chunks_; ++c) set_scale(chunks_[static_cast<std::size_t>(c)]);
}

void ShapeColumns::set_scale(PriceChunk& chunk) noexcept {
  if (chunk.is_behind) {
    for (int lane = 0; lane < chunk.used; ++lane) {
      write_lane(chunk, lane, column(chunk.shape[static_cast<std::size_t>(lane)]).data());
    }
    chunk.is_behind = false;
  }
  const Ten lengths = lengths_.segment<10>(Eigen::Index{10} * chunk.link).cast<float>();
  scales(chunk.U.data(), lengths.data(), chunk.scale.data());
}

void ShapeColumns::unbar_all() noexcept {
  for (int c = 0; c < used_chunks_; ++c) {
    PriceChunk& chunk = chunks_[static_cast<std::size_t>(c)];
    chunk.barrier.head(chunk.used).setZero();
  }
}

// Single precision sees slopes beside the largest that these g could make, which is far less than
// what prices are measured by where the rows are met well.
int ShapeColumns::steepest(const Eigen::VectorXd& g, double threshold) noexcept {
  SHAPEID_CONTRACT(why_no_prices());
  steepest_ = -1;
  best_.clear();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    if (lengths_[i] > 0.0) largest = std::max(largest, std::abs(g[i]) / lengths_[i]);
  }
  // No price exceeds this, or the sign is all that counts.
  const double most_possible = largest * inverse_unit_;
  if (!(threshold < 0.0 || most_possible > threshold)) return -1;
  const double factor = largest > 0.0 ? 1.0 / largest : 0.0;
  const double least = largest > 0.0 ? threshold / most_possible : 0.0;
  // What is certainly below the threshold, also if that is negative.
  const float below = static_cast<float>(std::max(std::min(least, 0.0), -2.0)) - uncertain;
  float most = uncertain;
  uncertain_.clear();
  Ten gl = Ten::Zero();
  int link = -1;
  for (int c = 0; c < used_chunks_; ++c) {
    PriceChunk& chunk = chunks_[static_cast<std::size_t>(c)];
    if (chunk.link != link) {
      link = chunk.link;
      gl = (factor * g.segment<10>(Eigen::Index{10} * link)).cast<float>();
    }
    const Best here = price_by_lengths(chunk, gl.data());
    if (!(here.price <= no_price)) {
      // A float overflowed, and may stand above the barrier: double decides.
      uncertain_.push_back(c);
      continue;
    }
    if (here.price > below) uncertain_.push_back(c);
    const int shape = chunk.shape[here.lane];
    best_.push_back({shape, here.price});
    if (here.price > most && here.price > least) {
      most = here.price;
      steepest_ = shape;
    }
  }
  if (steepest_ < 0 && !uncertain_.empty()) {
    steepest_ = steepest_in_double(g, threshold, below, Judged::by_lengths, Kept::best);
  }
  return steepest_;
}

// One way through the shapes for both prices. Single precision knows the sign of a slope to a share
// of its own terms, so shapes whose slope is certainly negative by that are not asked in double,
// however small the slope is by lengths.
int ShapeColumns::steepest_or_by_terms(const Eigen::VectorXd& g, double threshold,
                                       double threshold_by_terms) noexcept {
  SHAPEID_CONTRACT(why_no_prices());
  steepest_ = -1;
  best_.clear();
  best_by_terms_.clear();
  uncertain_.clear();
  const double largest = g.lpNorm<Eigen::Infinity>();
  if (!(largest > 0.0)) return -1;
  const auto by_length = static_cast<float>(largest * inverse_unit_);
  float most = uncertain, most_by_terms = uncertain;
  int steepest_by_terms = -1;
  for (int c = 0; c < used_chunks_; ++c) {
    PriceChunk& chunk = chunks_[static_cast<std::size_t>(c)];
    const Ten gl = (g.segment<10>(Eigen::Index{10} * chunk.link) / largest).cast<float>();
    Best here{}, terms{};
    price_by_both(chunk.U.data(), gl.data(), chunk.scale.data(), chunk.barrier.data(), by_length,
                  chunk.last.data(), here, terms);
    if (!(here.price <= no_price && terms.price <= no_price)) {
      uncertain_.push_back(c);
      continue;
    }
    if (terms.price > -uncertain) uncertain_.push_back(c);
    best_.push_back({chunk.shape[here.lane], here.price});
    best_by_terms_.push_back({chunk.shape[terms.lane], terms.price});
    if (here.price > most) {
      most = here.price;
      steepest_ = best_.back().shape;
    }
    if (terms.price > most_by_terms) {
      most_by_terms = terms.price;
      steepest_by_terms = best_by_terms_.back().shape;
    }
  }
  if (steepest_ >= 0) return steepest_;
  steepest_ = steepest_in_double(g, threshold, -uncertain, Judged::by_lengths, Kept::all);
  if (steepest_ >= 0) return steepest_;
  if (steepest_by_terms >= 0) {
    best_.swap(best_by_terms_);
    return steepest_ = steepest_by_terms;
  }
  return steepest_ =
             steepest_in_double(g, threshold_by_terms, -uncertain, Judged::by_terms, Kept::all);
}

const std::vector<int>& ShapeColumns::steep_ones(Among among) noexcept {
  steep_ones_.clear();
  if (steepest_ < 0) return steep_ones_;
  steep_ones_.push_back(steepest_);
  if (links() == 1 && among == Among::links) return steep_ones_;
  float most = 0.0F;
  for (const Priced& best : best_) most = std::max(most, best.price);
  if (among == Among::all) {
    for (const Priced& best : best_) {
      if (best.price >= almost * most && best.shape != steepest_) steep_ones_.push_back(best.shape);
    }
    return steep_ones_;
  }
  std::fill(best_of_link_.begin(), best_of_link_.end(), Priced{-1, 0.0F});
  for (const Priced& best : best_) {
    Priced& of_link = best_of_link_[static_cast<std::size_t>(link(best.shape))];
    if (of_link.shape < 0 || best.price > of_link.price) of_link = best;
  }
  best_of_link_[static_cast<std::size_t>(link(steepest_))].shape = -1;
  for (const Priced& best : best_of_link_) {
    if (best.shape >= 0 && best.price >= almost_on_links * most) steep_ones_.push_back(best.shape);
  }
  return steep_ones_;
}

int ShapeColumns::steepest_in_double(const Eigen::VectorXd& g, double threshold, float below,
                                     Judged judged, Kept kept) noexcept {
  int steepest = -1;
  double most = threshold;
  std::array<Asked, lanes> asked;
  best_.clear();
  for (const int c : uncertain_) {
    const PriceChunk& chunk = chunks_[static_cast<std::size_t>(c)];
    unsigned left =
        ask(chunk, data(), g.data() + std::ptrdiff_t{10} * chunk.link, below, asked.data());
    Priced best{-1, 0.0F};
    double most_here = threshold;
    for (; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const int j = chunk.shape[lane];
      const auto [slope, terms] = asked[lane];
      const double here = judged == Judged::by_terms
                              ? slope / std::max(terms, std::numeric_limits<double>::min())
                              : price(j, slope);
      if (here > threshold && kept == Kept::all) best_.push_back({j, static_cast<float>(here)});
      if (here > most_here) {
        most_here = here;
        best = {j, static_cast<float>(here)};
      }
    }
    if (best.shape >= 0 && kept == Kept::best) best_.push_back(best);
    if (most_here > most) {
      most = most_here;
      steepest = best.shape;
    }
  }
  return steepest;
}

}  // namespace shapeid::fast
