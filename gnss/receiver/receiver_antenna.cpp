#include "canyon/gnss/receiver/receiver_antenna.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

class SineAntenna final : public ReceiverAntenna {
 public:
  explicit SineAntenna(const SineAntennaParameters& p) : p_(p) {}
  double rhcp_db(double elevation_rad) const override { return -p_.horizon_loss_db * (1.0 - std::sin(elevation_rad)); }
  double lhcp_db(double elevation_rad) const override { return rhcp_db(elevation_rad) - p_.lhcp_rejection_db; }
  double phase_centre_m(const Eigen::Vector3d&) const override { return 0.0; }

 private:
  SineAntennaParameters p_;
};

/// Gains every 15 deg from -90 to 90, phase-centre variation every 5 deg from 0 to 90; linear between.
struct PatternTable {
  std::array<double, 13> rhcp_db, lhcp_db;
  double north_mm, east_mm, up_mm;
  std::array<double, 19> variation_mm;  ///< by growing elevation
};

class TabulatedAntenna final : public ReceiverAntenna {
 public:
  explicit TabulatedAntenna(const PatternTable& table) : table_(table) {}
  double rhcp_db(double elevation_rad) const override { return gain(table_.rhcp_db, elevation_rad); }
  double lhcp_db(double elevation_rad) const override { return gain(table_.lhcp_db, elevation_rad); }
  double phase_centre_m(const Eigen::Vector3d& u) const override {
    const double elevation_deg = std::asin(std::clamp(u.z(), -1.0, 1.0)) / kDegree;
    const double offset_mm = table_.east_mm * u.x() + table_.north_mm * u.y() + table_.up_mm * u.z();
    return 1e-3 * (interpolate(table_.variation_mm, std::max(elevation_deg, 0.0) / 5.0) - offset_mm);
  }

 private:
  template <std::size_t N>
  static double interpolate(const std::array<double, N>& nodes, double x) {
    x = std::clamp(x, 0.0, static_cast<double>(N - 1));
    const auto i = std::min(static_cast<std::size_t>(x), N - 2);
    const double s = x - static_cast<double>(i);
    return nodes[i] * (1.0 - s) + nodes[i + 1] * s;
  }
  static double gain(const std::array<double, 13>& nodes, double elevation_rad) {
    return interpolate(nodes, (elevation_rad / kDegree + 90.0) / 15.0);
  }

  const PatternTable& table_;
};

// Every direction alike, and no left-hand reception to speak of: what a formula without an antenna assumes.
constexpr PatternTable kIsotropic{
    {}, {-100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100, -100}, 0, 0, 0, {}};

// Active ceramic patch on a car roof. Zenith gain about 3.5 dBic falling to -3.5 at the horizon, axial ratio 2 dB at
// the zenith (18.8 dB of rejection of the other hand), growing to 12 dB at the horizon (4.5 dB), as data sheets of such
// antennas show on a ground plane of 10 to 15 cm (u-blox ANN-MB, Taoglas AA.170); the ground plane shades arrivals from
// below. Phase centre 8.9 mm above its base (ANN-MB data sheet), variation not known.
constexpr PatternTable kPatch{{-22, -21, -19, -16, -13, -10, -7, -4.3, -2.6, -1.3, -0.5, -0.1, 0.0},
                              {-20, -19, -17, -15.5, -14, -12.5, -11.5, -11.5, -12.5, -14, -16, -18, -18.8},
                              0,
                              0,
                              8.9,
                              {}};

// Aperture-coupled slot array for surveying ("pinwheel"): 12 to 13 dB from zenith to horizon, left hand below -20 dB
// from the zenith (NovAtel GPS-702-GG data sheet; gain pattern as published there). Phase centre: IGS igs05.atx,
// NOV702GG NONE, G01, 21-NOV-07.
constexpr PatternTable kSurvey{{-32, -31, -30, -28, -24, -18.5, -12.5, -8.0, -4.6, -2.4, -1.0, -0.2, 0.0},
                               {-30, -29, -28, -27, -26, -24, -20.5, -20, -21, -22, -23, -24, -25},
                               1.35,
                               0.30,
                               66.76,
                               {1.59, 1.11, 0.49, -0.11, -0.58, -0.88, -1.00, -1.00, -0.93, -0.82, -0.71, -0.58, -0.45,
                                -0.33, -0.22, -0.12, -0.05, -0.01, 0.00}};

// Choke ring of Dorne-Margolin type: horizon 11 dB below the zenith, arrivals from below and left hand suppressed
// further (Tranquilla, Carr & Al-Rizzo 1994). Phase centre: igs05.atx, AOAD/M_T NONE, G01, 27-JAN-03.
constexpr PatternTable kChokeRing{{-35, -34, -33, -31, -27, -20, -11.5, -7.2, -4.3, -2.3, -1.0, -0.3, 0.0},
                                  {-32, -32, -31, -30, -29, -27, -24, -22, -23, -25, -27, -29, -30},
                                  0.60,
                                  -0.46,
                                  91.24,
                                  {14.88, 9.56, 4.79, 0.87, -2.20, -4.54, -6.27, -7.46, -8.14, -8.30, -7.97, -7.19,
                                   -6.05, -4.69, -3.28, -1.97, -0.92, -0.24, 0.00}};

std::shared_ptr<const ReceiverAntenna> make_isotropic(const ModelParameters&) {
  return std::make_shared<TabulatedAntenna>(kIsotropic);
}
std::shared_ptr<const ReceiverAntenna> make_patch(const ModelParameters&) {
  return std::make_shared<TabulatedAntenna>(kPatch);
}
std::shared_ptr<const ReceiverAntenna> make_survey(const ModelParameters&) {
  return std::make_shared<TabulatedAntenna>(kSurvey);
}
std::shared_ptr<const ReceiverAntenna> make_choke_ring(const ModelParameters&) {
  return std::make_shared<TabulatedAntenna>(kChokeRing);
}

constexpr ModelRow<MakeAntenna> kAntennas[] = {
    {"sine", [](const ModelParameters& own) { return make_sine_antenna(own.get<SineAntennaParameters>()); },
     "antenna_horizon_loss_db (1 - sin e), left hand lhcp_rejection_db lower", parameters_of<SineAntennaParameters>},
    {"isotropic", make_isotropic, "0 dB everywhere, right-hand only"},
    {"patch", make_patch, "active patch on a car roof"},
    {"survey", make_survey, "slot array for surveying, NOV702GG"},
    {"choke_ring", make_choke_ring, "choke ring, AOAD/M_T"},
};

}  // namespace

void visit(FieldVisitor& f, SineAntennaParameters& c) {
  f.number("antenna_horizon_loss_db", c.horizon_loss_db, {0.0, 40.0},
           "antenna sine: gain at the horizon below that at the zenith");
  f.number("lhcp_rejection_db", c.lhcp_rejection_db, {0.0, 60.0},
           "antenna sine: gain for left-hand below right-hand polarization");
}

ModelTable<MakeAntenna> antenna_models() {
  return kAntennas;
}

std::shared_ptr<const ReceiverAntenna> make_sine_antenna(const SineAntennaParameters& p) {
  return std::make_shared<SineAntenna>(p);
}

}  // namespace canyon::gnss
