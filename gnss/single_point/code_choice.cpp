#include "canyon/gnss/single_point/code_choice.h"

#include <string_view>

namespace canyon::gnss {
namespace {

/// Attributes in descending preference.
struct BandChoice {
  char band;
  std::string_view attributes;
};
using Choices = std::vector<BandChoice>;

struct BySystem {
  Choices gps, glonass, galileo, beidou, qzss, sbas;

  const Choices& of(GnssSystem system) const {
    switch (system) {
      case GnssSystem::kGps:
        return gps;
      case GnssSystem::kGlonass:
        return glonass;
      case GnssSystem::kGalileo:
        return galileo;
      case GnssSystem::kBeidou:
        return beidou;
      case GnssSystem::kQzss:
        return qzss;
      case GnssSystem::kSbas:
        return sbas;
    }
    return gps;
  }
};

const Choices& single_choices(GnssSystem system) {
  static const BySystem choices{.gps = {{'1', "CPWYMXLSN"}},
                                .glonass = {{'1', "CP"}},
                                .galileo = {{'1', "CXBAZ"}},
                                .beidou = {{'2', "IXQ"}, {'1', "PXD"}},
                                .qzss = {{'1', "CXLSZ"}},
                                .sbas = {{'1', "C"}}};
  return choices.of(system);
}

const Choices& dual_first(GnssSystem system) {
  static const Choices gps{{'1', "WPYCXLS"}}, glonass{{'1', "PC"}};
  if (system == GnssSystem::kGps) return gps;
  if (system == GnssSystem::kGlonass) return glonass;
  return single_choices(system);
}

const Choices& dual_second(GnssSystem system) {
  static const BySystem choices{.gps = {{'2', "WPYLXSCDMN"}, {'5', "QXI"}},
                                .glonass = {{'2', "PC"}},
                                .galileo = {{'5', "QXI"}, {'7', "QXI"}},
                                .beidou = {{'6', "IXQ"}, {'7', "IXQ"}, {'5', "PXD"}},
                                .qzss = {{'2', "LXS"}, {'5', "QXI"}},
                                .sbas = {{'5', "IXQ"}}};
  return choices.of(system);
}

const ObservationValue* find(const std::vector<ObservationCode>& codes, const SatelliteObservations& s,
                             ObservationCode code) {
  for (std::size_t i = 0; i < codes.size() && i < s.values.size(); ++i)
    if (codes[i] == code && !s.values[i].missing()) return &s.values[i];
  return nullptr;
}

/// Phase, Doppler or strength of the signal; RINEX 2 files name them by band alone, so any of the band will do.
const ObservationValue* beside(const std::vector<ObservationCode>& codes, const SatelliteObservations& s, char kind,
                               const ObservationCode& code) {
  if (const auto* same = find(codes, s, {kind, code.band, code.attribute})) return same;
  for (std::size_t i = 0; i < codes.size() && i < s.values.size(); ++i)
    if (codes[i].kind == kind && codes[i].band == code.band && !s.values[i].missing()) return &s.values[i];
  return nullptr;
}

std::optional<SignalObservation> choose(const Choices& choices, const std::vector<ObservationCode>& codes,
                                        const SatelliteObservations& s) {
  for (const BandChoice& choice : choices)
    for (const char attribute : choice.attributes) {
      const ObservationCode code{'C', choice.band, attribute};
      const auto* range = find(codes, s, code);
      if (range == nullptr) continue;
      SignalObservation out;
      out.code = code;
      out.pseudorange_m = range->value;
      if (const auto* phase = beside(codes, s, 'L', code)) {
        out.phase_cycles = phase->value;
        out.loss_of_lock = (phase->loss_of_lock & 1) != 0;
      }
      if (const auto* doppler = beside(codes, s, 'D', code)) out.doppler_hz = doppler->value;
      if (const auto* strength = beside(codes, s, 'S', code)) out.cn0_dbhz = strength->value;
      return out;
    }
  return std::nullopt;
}

}  // namespace

std::optional<SignalObservation> single_frequency_signal(const std::vector<ObservationCode>& codes,
                                                         const SatelliteObservations& satellite) {
  return choose(single_choices(satellite.sv.system), codes, satellite);
}

std::optional<SignalPair> dual_frequency_signals(const std::vector<ObservationCode>& codes,
                                                 const SatelliteObservations& satellite) {
  const auto first = choose(dual_first(satellite.sv.system), codes, satellite);
  const auto second = choose(dual_second(satellite.sv.system), codes, satellite);
  if (!first || !second) return std::nullopt;
  return SignalPair{*first, *second};
}

}  // namespace canyon::gnss
