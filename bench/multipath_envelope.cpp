// Multipath error envelopes as CSV: error of the code in metres against the delay of one echo of half amplitude (-6
// dB), in phase (_in) and in opposite phase (_out), antenna at rest. `canyon_multipath_envelope > envelope.csv`
#include <cmath>
#include <cstdio>

#include "canyon/core/units.h"
#include "canyon/gnss/receiver/code_tracking.h"

namespace {

using canyon::gnss::CodeTracking;
using canyon::gnss::CorrelatorDesign;
using canyon::gnss::Modulation;

struct Curve {
  const char* name;
  Modulation modulation;
  double spacing_chips;
  bool double_delta;
  bool coherent;
  double front_end_hz;
};

constexpr Curve kCurves[] = {
    {"bpsk1_d1.0", Modulation::kBpsk1, 1.0, false, true, 0.0},
    {"bpsk1_d0.1", Modulation::kBpsk1, 0.1, false, true, 0.0},
    {"boc11_d0.1", Modulation::kBoc11, 0.1, false, true, 0.0},
    {"bpsk10_d0.5", Modulation::kBpsk10, 0.5, false, true, 0.0},
    {"bpsk1_d1.0_8MHz", Modulation::kBpsk1, 1.0, false, true, 8e6},
    {"bpsk1_d0.1_16MHz", Modulation::kBpsk1, 0.1, false, true, 16e6},
    {"bpsk1_d0.1_16MHz_power", Modulation::kBpsk1, 0.1, false, false, 16e6},
    {"boc11_d0.1_16MHz", Modulation::kBoc11, 0.1, false, true, 16e6},
    {"bpsk1_d0.1_strobe", Modulation::kBpsk1, 0.1, true, true, 0.0},
    {"bpsk1_d0.1_strobe_16MHz", Modulation::kBpsk1, 0.1, true, true, 16e6},
};

double error_m(const CodeTracking& tracking, double delay_m, double phase_rad) {
  const canyon::gnss::EchoSignal signals[] = {{0.0, 1.0, 0.0, 0.0}, {delay_m, 0.5, phase_rad, 0.0}};
  const auto lock = tracking.track(signals);
  return lock ? lock->delay_m : std::nan("");
}

}  // namespace

int main() {
  std::vector<CodeTracking> trackings;
  std::printf("delay_m");
  for (const Curve& c : kCurves) {
    CorrelatorDesign d;
    d.modulation = c.modulation;
    d.spacing_chips = c.spacing_chips;
    d.double_delta = c.double_delta;
    d.coherent = c.coherent;
    d.front_end_hz = c.front_end_hz;
    trackings.emplace_back(d);
    std::printf(",%s_in_m,%s_out_m", c.name, c.name);
  }
  std::printf("\n");
  for (double delay_m = 0.0; delay_m <= 480.0; delay_m += 2.0) {
    std::printf("%.0f", delay_m);
    for (const CodeTracking& tracking : trackings)
      std::printf(",%.4f,%.4f", error_m(tracking, delay_m, 0.0), error_m(tracking, delay_m, canyon::kPi));
    std::printf("\n");
  }
}
