// Columns of U, stored so that a shape is priced with ten numbers of its link.
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <vector>

#include "shapeid/fast/price_chunk.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {

/// Unit parameters of shapes on links, sixteen shapes of one link beside each other in memory, so
/// that pricing runs over whole registers. Shapes are numbered in the order in which they came.
/// Memory grows with the shapes, not with shapes times links.
///
/// Nothing allocates or throws after construction.
class ShapeColumns {
 public:
  using Column = Eigen::Matrix<double, 10, 1>;

  /// Room for `most_shapes` shapes, however they spread over `links` links.
  ShapeColumns(int links, int most_shapes);

  void clear() noexcept;

  /// Adds a shape; false if there is no room. `link`: place among the free links.
  [[nodiscard]] bool append(int link, const Column& u) noexcept;
  /// Gives shape `j` another column, on the same link.
  void replace(int j, const Column& u) noexcept;

  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] int capacity() const noexcept { return static_cast<int>(slots_.size()); }
  [[nodiscard]] int links() const noexcept { return static_cast<int>(last_of_link_.size()); }
  [[nodiscard]] int link(int j) const noexcept { return links_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] auto column(int j) const noexcept { return columns_.col(j); }
  /// All columns, one behind the other.
  [[nodiscard]] const double* data() const noexcept { return columns_.data(); }

  /// What slopes are judged by. `lengths`: of the columns of R, or upper bounds of them (10 per
  /// link); `length`: of the right-hand side. No slope u_j . g that comes from a right-hand side of
  /// this length is larger than length x sum_i |u_ij| lengths_i.
  void set_scale(const Eigen::VectorXd& lengths, double length) noexcept;
  /// No price is asked until the next set_scale(): columns that come until then are priced by it.
  void forget_scale() noexcept { has_scale_ = false; }
  [[nodiscard]] bool has_scale() const noexcept { return has_scale_; }
  /// Empty if prices may be asked.
  [[nodiscard]] Violation why_no_prices() const {
    if (has_scale_) return std::nullopt;
    return "prices are asked of columns whose scale was forgotten";
  }
  /// A slope of shape j over that bound: free of units, to single precision.
  [[nodiscard]] double price(int j, double slope) const noexcept {
    SHAPEID_CONTRACT(why_no_prices());
    const Slot& slot = slots_[static_cast<std::size_t>(j)];
    const double scale = chunks_[static_cast<std::size_t>(slot.chunk)].scale[slot.lane];
    return unit_ > 0.0 ? slope * scale * inverse_unit_ : slope;
  }

  /// The shape of the largest price, if it exceeds `threshold`; of those that are not barred. -1 if
  /// there is none. `g`: 10 per link. All shapes are priced in single precision; double
  /// decides where single cannot.
  [[nodiscard]] int steepest(const Eigen::VectorXd& g, double threshold) noexcept;
  /// The same; but if there is none, that of the largest price by its own terms, its slope over
  /// sum_i |u_ij g_i|, if it exceeds `threshold_by_terms`. For slopes that are all small beside
  /// what set_scale() judges by. Thresholds: zero or positive.
  [[nodiscard]] int steepest_or_by_terms(const Eigen::VectorXd& g, double threshold,
                                         double threshold_by_terms) noexcept;
  /// After either: that shape, then others with prices almost as large, by what decided of that
  /// one: the best of other links, or any. (Single precision knows the best of every sixteen.)
  enum class Among { links, all };
  [[nodiscard]] const std::vector<int>& steep_ones(Among among) noexcept;
  /// Bars a shape from steepest(), or admits it again.
  void bar(int j, bool is_barred) noexcept {
    const Slot& slot = slots_[static_cast<std::size_t>(j)];
    chunks_[static_cast<std::size_t>(slot.chunk)].barrier[slot.lane] = is_barred ? barred : 0.0F;
  }
  struct Slot {
    int chunk, lane;
  };
  /// Where a shape is priced.
  [[nodiscard]] const Slot& slot(int j) const noexcept {
    return slots_[static_cast<std::size_t>(j)];
  }
  /// What is priced: sixteen shapes at a time.
  [[nodiscard]] PriceChunk* chunks() noexcept { return chunks_.data(); }
  [[nodiscard]] int used_chunks() const noexcept { return used_chunks_; }
  /// The largest length.
  [[nodiscard]] double largest() const noexcept { return largest_; }
  /// What slopes are multiplied by before single precision prices them.
  [[nodiscard]] double inverse_unit() const noexcept { return inverse_unit_; }
  /// sum_i |u_ij| lengths_i, to single precision: R u_j is no longer.
  [[nodiscard]] double bound(int j) const noexcept {
    SHAPEID_CONTRACT(why_no_prices());
    const Slot& slot = slots_[static_cast<std::size_t>(j)];
    const PriceChunk& chunk = chunks_[static_cast<std::size_t>(slot.chunk)];
    return largest_ / static_cast<double>(chunk.scale[slot.lane]);
  }
  /// Admits all shapes.
  void unbar_all() noexcept;

 private:
  static constexpr int lanes = PriceChunk::lanes;
  struct Priced {
    int shape;
    float price;
  };

  enum class Judged { by_lengths, by_terms };
  enum class Kept { best, all };  ///< of a chunk
  void write(int j, const Column& u) noexcept;
  void write_lane(PriceChunk& chunk, int lane, const double* u) noexcept;
  void set_scale(PriceChunk& chunk) noexcept;
  [[nodiscard]] int steepest_in_double(const Eigen::VectorXd& g, double threshold, float below,
                                       Judged judged, Kept kept) noexcept;

  int size_ = 0;
  int used_chunks_ = 0;
  bool has_scale_ = true;
  std::vector<PriceChunk> chunks_;
  std::vector<Slot> slots_;                            ///< of every shape
  std::vector<int> links_;                             ///< of every shape
  Eigen::Matrix<double, 10, Eigen::Dynamic> columns_;  ///< in double, one behind the other
  std::vector<int> last_of_link_;  ///< the chunk that a link's next shape goes to, or -1
  std::vector<Priced> best_;       ///< of every chunk, or all that exceeded, at the last steepest()
  std::vector<Priced> best_by_terms_;
  std::vector<Priced> best_of_link_;
  int steepest_ = -1;  ///< at the last steepest()
  std::vector<int> steep_ones_;
  std::vector<int> uncertain_;  ///< chunks that single precision cannot decide
  Eigen::VectorXd lengths_;     ///< relative to the largest, so that single precision holds them
  double largest_ = 1.0;        ///< of the lengths
  double unit_ = 1.0;           ///< the largest length x that of the right-hand side
  double inverse_unit_ = 1.0;   ///< if it is positive
};

}  // namespace shapeid::fast
