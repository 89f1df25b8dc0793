#include "canyon/study/registration_error/shapley.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "canyon/core/check.h"
#include "canyon/core/messages.h"
#include "canyon/core/random/random.h"

namespace canyon::study {
namespace {

Coalition everybody(std::size_t players) {
  CANYON_CHECK(players <= kMostPlayers, players, " players");
  return (Coalition{1} << players) - 1;
}

/// How each player's leaving changes the value, in this order.
std::vector<double> contributions(const std::vector<std::size_t>& order, const std::map<Coalition, double>& value) {
  std::vector<double> out(order.size());
  Coalition present = everybody(order.size());
  for (const std::size_t player : order) {
    const Coalition left = present & ~(Coalition{1} << player);
    out[player] = value.at(present) - value.at(left);
    present = left;
  }
  return out;
}

}  // namespace

std::vector<std::vector<std::size_t>> sampled_orders(std::size_t players, std::size_t count, std::uint64_t seed) {
  const RandomStream stream(seed, "study.error_budget.orders");
  std::vector<std::vector<std::size_t>> orders;
  for (std::uint64_t pair = 0; orders.size() < count; ++pair) {
    std::vector<std::size_t> order(players);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t k = players; k > 1; --k) {
      const double draw = stream.uniform(static_cast<std::uint32_t>(k), pair);
      std::swap(order[k - 1], order[std::min(k - 1, static_cast<std::size_t>(draw * static_cast<double>(k)))]);
    }
    orders.push_back(order);
    std::reverse(order.begin(), order.end());
    orders.push_back(order);
  }
  return orders;
}

std::vector<Coalition> coalitions_of(const std::vector<std::vector<std::size_t>>& orders, std::size_t players) {
  std::vector<Coalition> out{everybody(players), 0};
  for (const auto& order : orders) {
    Coalition present = everybody(players);
    for (const std::size_t player : order) {
      present &= ~(Coalition{1} << player);
      out.push_back(present);
    }
  }
  std::sort(out.begin(), out.end(), std::greater<>());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

ShapleyShares shapley_shares(const std::vector<std::vector<std::size_t>>& orders, std::size_t players,
                             const std::vector<Coalition>& coalitions, const std::vector<double>& value) {
  CANYON_CHECK(coalitions.size() == value.size(), coalitions.size(), " coalitions, ", value.size(), " values");
  std::map<Coalition, double> by_coalition;
  for (std::size_t i = 0; i < value.size(); ++i) by_coalition[coalitions[i]] = value[i];
  ShapleyShares out;
  out.total = by_coalition.at(everybody(players));
  out.floor = by_coalition.at(0);
  out.share.assign(players, 0.0);
  out.order_sigma.assign(players, kNaN);
  const std::size_t pairs = orders.size() / 2;
  if (pairs == 0) return out;
  std::vector<std::vector<double>> of_pair;
  for (std::size_t k = 0; k < pairs; ++k) {
    of_pair.push_back(contributions(orders[2 * k], by_coalition));
    const auto back = contributions(orders[2 * k + 1], by_coalition);
    for (std::size_t i = 0; i < players; ++i) of_pair[k][i] = 0.5 * (of_pair[k][i] + back[i]);
    for (std::size_t i = 0; i < players; ++i) out.share[i] += of_pair[k][i] / static_cast<double>(pairs);
  }
  if (pairs < 2) return out;
  for (std::size_t i = 0; i < players; ++i) {
    double squares = 0.0;
    for (const auto& shares : of_pair) squares += std::pow(shares[i] - out.share[i], 2);
    out.order_sigma[i] = std::sqrt(squares / static_cast<double>((pairs - 1) * pairs));
  }
  return out;
}

}  // namespace canyon::study
