#include "canyon/gnss/signal.h"

namespace canyon::gnss {
namespace {

struct Carrier {
  GnssSystem system;
  int band;
  double hz;
  double per_channel_hz;  ///< GLONASS FDMA
};

constexpr Carrier kCarriers[] = {
    {GnssSystem::kGps, 1, 1575.42e6, 0},          {GnssSystem::kGps, 2, 1227.60e6, 0},
    {GnssSystem::kGps, 5, 1176.45e6, 0},          {GnssSystem::kGlonass, 1, 1602.0e6, 562.5e3},
    {GnssSystem::kGlonass, 2, 1246.0e6, 437.5e3}, {GnssSystem::kGlonass, 3, 1202.025e6, 0},
    {GnssSystem::kGlonass, 4, 1600.995e6, 0},     {GnssSystem::kGlonass, 6, 1248.06e6, 0},
    {GnssSystem::kGalileo, 1, 1575.42e6, 0},      {GnssSystem::kGalileo, 5, 1176.45e6, 0},
    {GnssSystem::kGalileo, 6, 1278.75e6, 0},      {GnssSystem::kGalileo, 7, 1207.140e6, 0},
    {GnssSystem::kGalileo, 8, 1191.795e6, 0},     {GnssSystem::kBeidou, 1, 1575.42e6, 0},
    {GnssSystem::kBeidou, 2, 1561.098e6, 0},      {GnssSystem::kBeidou, 5, 1176.45e6, 0},
    {GnssSystem::kBeidou, 6, 1268.52e6, 0},       {GnssSystem::kBeidou, 7, 1207.140e6, 0},
    {GnssSystem::kBeidou, 8, 1191.795e6, 0},      {GnssSystem::kQzss, 1, 1575.42e6, 0},
    {GnssSystem::kQzss, 2, 1227.60e6, 0},         {GnssSystem::kQzss, 5, 1176.45e6, 0},
    {GnssSystem::kQzss, 6, 1278.75e6, 0},         {GnssSystem::kSbas, 1, 1575.42e6, 0},
    {GnssSystem::kSbas, 5, 1176.45e6, 0},
};

}  // namespace

double carrier_hz(GnssSystem system, int band, int channel) {
  for (const Carrier& c : kCarriers)
    if (c.system == system && c.band == band)
      return c.per_channel_hz != 0.0 && channel == kUnknownChannel ? kNaN : c.hz + channel * c.per_channel_hz;
  return kNaN;
}

int first_band(GnssSystem system) {
  return system == GnssSystem::kBeidou ? 2 : 1;
}

int second_band(GnssSystem system, SecondFrequency second) {
  const bool l5 = second == SecondFrequency::kL5;
  switch (system) {
    case GnssSystem::kGlonass:
      return 2;
    case GnssSystem::kGalileo:
      return l5 ? 5 : 7;
    case GnssSystem::kBeidou:
      return l5 ? 5 : 6;  // B3I: only BeiDou-2 sends B2I
    case GnssSystem::kGps:
    case GnssSystem::kQzss:
    case GnssSystem::kSbas:
      break;
  }
  return l5 || system == GnssSystem::kSbas ? 5 : 2;
}

}  // namespace canyon::gnss
