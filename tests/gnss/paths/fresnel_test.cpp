#include "canyon/gnss/paths/diffraction/fresnel.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/gnss/signal.h"
#include "canyon/scene/surfaces/material.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::gnss {
namespace {

void expect_row(std::complex<double> eta, double incidence_deg, double te, double tm, double cross, double co) {
  const Fresnel r = fresnel(eta, incidence_deg * kDegree);
  EXPECT_NEAR(std::abs(r.te), te, 1e-3) << eta << " at " << incidence_deg;
  EXPECT_NEAR(std::abs(r.tm), tm, 1e-3) << eta << " at " << incidence_deg;
  EXPECT_NEAR(std::abs(r.cross), cross, 1e-3) << eta << " at " << incidence_deg;
  EXPECT_NEAR(std::abs(r.co), co, 1e-3) << eta << " at " << incidence_deg;
}

// The whole table of an independent computation, to its three digits.
TEST(Fresnel, TablesAtL1) {
  CANYON_REAL_DATA(path, "materials/fresnel_L1_tables.txt");
  std::ifstream file(path);
  std::string line;
  double eps = 0.0, sigma = 0.0;
  int rows = 0;
  while (std::getline(file, line)) {
    double angle, te, tm, cross, co;
    if (const auto at = line.find(" eps "); at != std::string::npos) {
      ASSERT_EQ(std::sscanf(line.c_str() + at, " eps %lf sigma %lf", &eps, &sigma), 2);
    } else if (std::sscanf(line.c_str(), " %lf: TE %lf TM %lf | RHCP->LHCP %lf (%*f dB) RHCP->RHCP %lf", &angle, &te,
                           &tm, &cross, &co) == 5) {
      expect_row({eps, -17.98 * sigma / (kL1Hz * 1e-9)}, angle, te, tm, cross, co);
      ++rows;
    }
  }
  EXPECT_GE(rows, 60);
}

// Twin: rows of that table for concrete and metal, with the permittivities of the built-in materials.
TEST(Fresnel, ConcreteAndMetal) {
  for (const auto& m : scene::builtin_materials()) {
    const auto eta = m.permittivity(kL1Hz);
    if (m.name == "concrete") {
      expect_row(eta, 0, 0.396, 0.396, 0.396, 0.000);
      expect_row(eta, 45, 0.513, 0.264, 0.388, 0.125);
      expect_row(eta, 60, 0.621, 0.111, 0.365, 0.257);
      expect_row(eta, 85, 0.920, 0.637, 0.142, 0.778);
    }
    if (m.name == "metal") expect_row(eta, 60, 1.0, 1.0, 1.0, 0.0);
  }
}

// A slab against its closed forms: nothing of a thickness of nothing, the half-space if thick and lossy, nothing again
// at half a wavelength inside and most at a quarter, where n^2 makes (1 - n^2) / (1 + n^2) of a lossless one.
TEST(FresnelSlab, ThinThickHalfAndQuarterWave) {
  const double wavelength_m = kL1WavelengthM;
  const std::complex<double> concrete(5.24, -0.75), glass(6.25, 0.0);
  EXPECT_LT(std::abs(fresnel_slab(concrete, 1e-9, wavelength_m, 0.5).te), 1e-6);
  for (const double incidence_rad : {0.0, 0.7, 1.4}) {
    const Fresnel half = fresnel(concrete, incidence_rad),
                  thick = fresnel_slab(concrete, 5.0, wavelength_m, incidence_rad);
    EXPECT_LT(std::abs(half.te - thick.te), 1e-6);
    EXPECT_LT(std::abs(half.tm - thick.tm), 1e-6);
  }
  EXPECT_LT(std::abs(fresnel_slab(glass, 0.5 * wavelength_m / 2.5, wavelength_m, 0.0).te), 1e-12);
  EXPECT_NEAR(fresnel_slab(glass, 0.25 * wavelength_m / 2.5, wavelength_m, 0.0).te.real(), (1.0 - 6.25) / (1.0 + 6.25),
              1e-12);
  // Energy: what a lossless slab does not reflect goes through, so it never exceeds 1; a conductor reflects all.
  for (double d_m = 0.001; d_m < 0.3; d_m += 0.007)
    for (double incidence_rad = 0.0; incidence_rad < 1.57; incidence_rad += 0.1)
      EXPECT_LE(std::abs(fresnel_slab(glass, d_m, wavelength_m, incidence_rad).tm), 1.0 + 1e-12);
  EXPECT_NEAR(std::abs(fresnel_slab({1.0, -1e8}, 0.001, wavelength_m, 0.3).te), 1.0, 1e-3);
}

TEST(Fresnel, LimitsAndBrewster) {
  const std::complex<double> glass(6.31, 0.0);
  // Normal incidence: (1 - n)/(1 + n), the sense of rotation reverses whole. Grazing: -1, it stays whole.
  const double n = std::sqrt(6.31);
  EXPECT_NEAR(std::abs(fresnel(glass, 0.0).te), (n - 1.0) / (n + 1.0), 1e-15);
  EXPECT_NEAR(std::abs(fresnel(glass, 0.0).co), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(fresnel(glass, kPi / 2).co), 1.0, 1e-14);
  // Without loss the TM part vanishes at tan(i) = n; both circular parts are then equal.
  const Fresnel b = fresnel(glass, std::atan(n));
  EXPECT_NEAR(std::abs(b.tm), 0.0, 1e-14);
  EXPECT_NEAR(std::abs(b.co), std::abs(b.cross), 1e-14);
  // Vacuum reflects nothing.
  EXPECT_EQ(std::abs(fresnel(1.0, 1.0).te), 0.0);
  // A passive surface never gives back more than it gets: |co|^2 + |cross|^2 <= 1.
  for (double incidence = 0.0; incidence < kPi / 2; incidence += 0.01) {
    const Fresnel r = fresnel({15.0, -3.0}, incidence);
    EXPECT_LE(std::norm(r.co) + std::norm(r.cross), 1.0);
  }
}

}  // namespace
}  // namespace canyon::gnss
