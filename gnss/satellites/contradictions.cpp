#include "canyon/gnss/satellites/contradictions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace canyon::gnss {
namespace {

constexpr double kTooFarM = 5e3;

NavigationMessage message_of(const KeplerEphemeris& r) {
  return r.message;
}
NavigationMessage message_of(const GlonassEphemeris&) {
  return NavigationMessage::kFdma;
}
double reach_s(const KeplerEphemeris&) {
  return 4.0 * 3600.0;
}
double reach_s(const GlonassEphemeris&) {
  return 3600.0;
}

template <class Record>
double distance_m(const Record& a, const Record& b, GpsTime t) {
  return (a.at(t).p_E - b.at(t).p_E).norm();
}

template <class Record>
std::vector<Contradiction> find(const std::vector<Record>& records) {
  std::vector<std::size_t> order(records.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto kind = [&](std::size_t i) { return std::pair(records[i].sv, message_of(records[i])); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return kind(a) != kind(b) ? kind(a) < kind(b) : records[a].toe < records[b].toe;
  });

  std::vector<Contradiction> out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Record& r = records[order[k]];
    if (!r.healthy()) continue;
    std::vector<const Record*> neighbours;
    for (std::size_t j = k >= 2 ? k - 2 : 0; j < std::min(k + 3, order.size()); ++j) {
      const Record& n = records[order[j]];
      if (j != k && kind(order[j]) == kind(order[k]) && std::abs(n.toe - r.toe) <= reach_s(r)) neighbours.push_back(&n);
    }
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Record* n : neighbours) nearest_m = std::min(nearest_m, distance_m(*n, r, r.toe));
    if (neighbours.size() < 2 || nearest_m < kTooFarM) continue;
    bool agree = false;
    for (std::size_t a = 0; a < neighbours.size(); ++a)
      for (std::size_t b = a + 1; b < neighbours.size(); ++b)
        agree = agree || distance_m(*neighbours[a], *neighbours[b], r.toe) < kTooFarM;
    if (agree) out.push_back({order[k], nearest_m});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  return out;
}

}  // namespace

std::vector<Contradiction> contradictions(const std::vector<KeplerEphemeris>& records) {
  return find(records);
}

std::vector<Contradiction> contradictions(const std::vector<GlonassEphemeris>& records) {
  return find(records);
}

}  // namespace canyon::gnss
