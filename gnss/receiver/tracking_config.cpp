#include <algorithm>

#include "canyon/gnss/receiver/code_tracking.h"

namespace canyon::gnss {
namespace {

using Tracking = TrackingConfig;

constexpr ModelRow<std::optional<Modulation>> kModulationRows[] = {
    {"auto", std::nullopt, "each system's open signal"},
    {"bpsk0.5", Modulation::kBpsk05, "GLONASS FDMA"},
    {"bpsk1", Modulation::kBpsk1, "GPS and QZSS C/A, L2C"},
    {"bpsk2", Modulation::kBpsk2, "BeiDou B1I, B2I"},
    {"bpsk10", Modulation::kBpsk10, "GPS L5, Galileo E5a, BeiDou B3I"},
    {"boc11", Modulation::kBoc11, "Galileo E1, GPS L1C, BeiDou B1C"},
};
constexpr ModelRow<SecondFrequency> kSecondFrequencies[] = {
    {"L2", SecondFrequency::kL2, "L2 and its like"},
    {"L5", SecondFrequency::kL5, "L5, E5a, B2a"},
};
constexpr ModelRow<Tracking::Correlator> kCorrelators[] = {
    {"early_late", Tracking::Correlator::kEarlyLate, "one pair"},
    {"double_delta", Tracking::Correlator::kDoubleDelta, "two pairs"},
};
constexpr ModelRow<Tracking::Discriminator> kDiscriminators[] = {
    {"power", Tracking::Discriminator::kPower, "early minus late of powers"},
    {"coherent", Tracking::Discriminator::kCoherent, "early minus late in phase"},
};
constexpr ModelRow<HiddenSignals> kHiddenSignals[] = {
    {"as_received", HiddenSignals::kAsReceived, "tracked by their echoes where these are strong enough"},
    {"dropped", HiddenSignals::kDropped, "not tracked"},
    {"in_sight", HiddenSignals::kInSight, "what is not tracked is received as under a clear sky"},
};

}  // namespace

void visit(FieldVisitor& f, TrackingConfig& c) {
  f.choice("modulation", c.modulation, ModelTable<std::optional<Modulation>>(kModulationRows),
           "of the tracked signals; auto = each system's open signal");
  f.choice("second_frequency", c.second_frequency, ModelTable<SecondFrequency>(kSecondFrequencies),
           "mode dual: L2 and its like (Galileo E5b, BeiDou B3I), or L5, E5a, B2a");
  f.choice("correlator", c.correlator, ModelTable<Tracking::Correlator>(kCorrelators),
           "one or two pairs of early and late");
  f.choice("discriminator", c.discriminator, ModelTable<Tracking::Discriminator>(kDiscriminators),
           "early minus late of powers, or in phase");
  f.number("correlator_spacing_chips", c.correlator_spacing_chips, {0.01, 1.0}, "early to late, in the signal's chips");
  f.number("front_end_mhz", c.front_end_mhz, {0.0, 100.0},
           "two-sided bandwidth of the receiver, at least the signal's main lobes; 0 = infinite");
  f.number("code_loop_hz", c.code_loop_hz, {0.001, 20.0}, "noise bandwidth of the code loop");
  f.flag(
      "code_loop_memory", c.code_loop_memory,
      "multipath goes through the code loop, which follows it within 1 / (4 code_loop_hz) seconds; else it is there at "
      "once");
  f.number("carrier_loop_hz", c.carrier_loop_hz, {0.5, 50.0}, "noise bandwidth of the carrier loop");
  f.number("integration_ms", c.integration_ms, {1.0, 40.0}, "predetection integration");
  f.number("thermal_noise_scale", c.thermal_noise_scale, {0.0, 100.0},
           "thermal noise of code, carrier and Doppler, 1 = physical");
  f.number("multipath_scale", c.multipath_scale, {0.0, 100.0},
           "what echoes make of code, carrier and Doppler, 1 = physical; C/N0 and tracking stay");
  f.choice(
      "hidden_signals", c.hidden_signals, ModelTable<HiddenSignals>(kHiddenSignals),
      "satellites whose direct path is blocked: as received; not tracked; or, like all that is not tracked, received "
      "as under a clear sky, while those that are tracked by echoes stay so");
}

CorrelatorDesign TrackingConfig::channel(Modulation modulation_of_channel) const {
  CorrelatorDesign d;
  d.modulation = modulation_of_channel;
  d.spacing_chips = correlator_spacing_chips;
  d.double_delta = correlator == Correlator::kDoubleDelta;
  d.coherent = discriminator == Discriminator::kCoherent;
  const double lobes_hz = (d.modulation == Modulation::kBoc11 ? 4.0 : 2.0) * chip_rate_hz(d.modulation);
  if (front_end_mhz > 0.0) d.front_end_hz = std::max(1e6 * front_end_mhz, lobes_hz);
  d.code_loop_hz = code_loop_hz;
  d.carrier_loop_hz = carrier_loop_hz;
  d.integration_s = 1e-3 * integration_ms;
  return d;
}

}  // namespace canyon::gnss
