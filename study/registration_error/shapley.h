#pragma once

#include <cstdint>
#include <vector>

namespace canyon::study {

/// Some of several players, a bit each.
using Coalition = std::uint32_t;
inline constexpr std::size_t kMostPlayers = 31;

/// Orders in which players are taken away, drawn in pairs: one at random, and the same backwards. In each pair every
/// two players stand in either order once, so that of a value in which players act alone or two by two, as the mean
/// square of a sum does, the shares are exact after one pair (antithetic sampling: Mitchell et al., JMLR 23 (2022)).
/// `count` is rounded up to an even number.
std::vector<std::vector<std::size_t>> sampled_orders(std::size_t players, std::size_t count, std::uint64_t seed);

/// The coalitions that these orders go through, all players and none among them, each once, in a fixed order.
std::vector<Coalition> coalitions_of(const std::vector<std::vector<std::size_t>>& orders, std::size_t players);

/// Shares of the players in value(all) - value(none) (Shapley 1953; sampled: Castro, Gomez & Tejada 2009). They add
/// up to it exactly but for rounding, however few the orders.
struct ShapleyShares {
  double total = 0.0, floor = 0.0;  ///< value of all, value of none
  std::vector<double> share;        ///< by player
  /// 1-sigma of the shares from pair to pair of orders, over the root of their number: what further orders would
  /// change. NaN with one pair.
  std::vector<double> order_sigma;
};
/// `value` by coalition: same index as `coalitions`.
ShapleyShares shapley_shares(const std::vector<std::vector<std::size_t>>& orders, std::size_t players,
                             const std::vector<Coalition>& coalitions, const std::vector<double>& value);

}  // namespace canyon::study
