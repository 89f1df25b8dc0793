// Group delays of every navigation message, band by band, by its interface document.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/gnss/satellites/navigation_data.h"
#include "canyon/gnss/stress/satellites/drawn_records.h"
#include "canyon/gnss/stress/subjects.h"

namespace canyon::gnss {
namespace {

using made::Kind;
using made::kKinds;
using made::some_record;
using stress::kEpsilon;
using stress::Looks;
using Message = NavigationMessage;

/// Delays of each band as its document has them, in seconds: roundings.
StressFigure delays_of_messages() {
  Looks looks;
  const RandomStream draws(9, "stress.sent");
  const double g2 = std::pow(1575.42 / 1227.60, 2), g5 = std::pow(1575.42 / 1176.45, 2),
               g7 = std::pow(1575.42 / 1207.14, 2);
  for (const Kind& kind : kKinds) {
    const KeplerEphemeris r = some_record(kind, draws, 3);
    std::array<double, 10> exact{};
    unsigned lent = 0;
    switch (kind.message) {
      case Message::kLnav:
        exact[1] = r.tgd_s, exact[2] = g2 * r.tgd_s;
        break;
      case Message::kCnav:
      case Message::kCnav2:
        for (const std::size_t b : {1U, 2U, 5U}) exact[b] = r.tgd_s - r.isc_s[b];
        break;
      case Message::kInav:
        // E5a through E1: what differs of the two bands is (g5 - 1) of the group delay of E1 and E5a.
        exact[1] = r.tgd2_s, exact[7] = g7 * r.tgd2_s, exact[5] = r.tgd2_s + (g5 - 1.0) * r.tgd_s;
        break;
      case Message::kFnav:
        exact[1] = r.tgd_s, exact[5] = g5 * r.tgd_s;
        break;
      case Message::kD1:
      case Message::kD2:
        exact[1] = exact[2] = r.tgd_s, exact[7] = r.tgd2_s, lent = 2;
        break;
      default:
        exact[1] = exact[2] = r.tgd_s, exact[5] = r.tgd2_s, lent = 4;
    }
    const SatelliteState s = r.at(r.toe);
    for (std::size_t b = 0; b < 10; ++b) {
      looks.near(s.group_delay_s[b], exact[b], 8.0 * kEpsilon * 5e-8);
      looks.near(s.clock_of_band_s(static_cast<int>(b)), s.clock_s - exact[b], 8.0 * kEpsilon * 1e-3);
    }
    looks.right(s.borrowed_delay_bands == lent);
    looks.right(r.geostationary_frame() == (kind.message == Message::kD2));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> sent_delay_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "group delays of every navigation message",
           "a ratio of the other band, a delay of E5b's for E5a's", "as the interface documents have them: roundings",
           "of the bound"});
  rows.add("sent/delays", delays_of_messages);
  return rows.take();
}

}  // namespace canyon::gnss
