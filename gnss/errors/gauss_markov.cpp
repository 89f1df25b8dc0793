#include "canyon/gnss/errors/gauss_markov.h"

#include <array>
#include <cmath>

#include "canyon/core/check.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kMemory = 128;
constexpr double kNodesPerTau = 8.0;
constexpr double kPhi = 0.88249690258459546;  // exp(-1 / kNodesPerTau), spelt out so that no libm rounds it differently

std::array<double, kMemory> make_weights() {
  std::array<double, kMemory> w{};
  double value = 1.0, sum = 0.0;
  for (auto& x : w) {
    x = value;
    sum += value * value;
    value *= kPhi;
  }
  for (auto& x : w) x /= std::sqrt(sum);
  return w;
}

}  // namespace

GaussMarkov::GaussMarkov(std::uint64_t seed, std::string_view name, double tau_s)
    : draws_(seed, name), node_ns_(static_cast<std::int64_t>(std::llround(tau_s * 1e9 / kNodesPerTau))) {
  CANYON_CHECK(node_ns_ > 0, "tau_s = ", tau_s);
}

GaussMarkov::Nodes GaussMarkov::nodes_of(std::uint32_t entity, std::int64_t first) const {
  static const std::array<double, kMemory> weights = make_weights();
  // Draws of nodes first - 127 ... first + 1; the indices are shifted so that they stay positive at the GPS epoch.
  std::array<double, kMemory + 1> w{};
  draws_.fill_normal(w, entity, static_cast<std::uint64_t>(first) + 1);
  Nodes nodes{.first = first};
  for (std::size_t j = 0; j < kMemory; ++j) {
    nodes.now += weights[j] * w[kMemory - 1 - j];
    nodes.next += weights[j] * w[kMemory - j];
  }
  return nodes;
}

double GaussMarkov::at(std::uint32_t entity, GpsTime t) const {
  CANYON_CHECK(t.ns >= 0, "t = ", t.ns, " ns");
  const std::int64_t first = t.ns / node_ns_;
  const double s = static_cast<double>(t.ns % node_ns_) / static_cast<double>(node_ns_);
  Nodes& nodes = last_[entity];
  if (nodes.first != first) nodes = nodes_of(entity, first);
  return ((1.0 - s) * nodes.now + s * nodes.next) /
         std::sqrt((1.0 - s) * (1.0 - s) + s * s + 2.0 * s * (1.0 - s) * kPhi);
}

}  // namespace canyon::gnss
