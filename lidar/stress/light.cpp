// Surfaces, panes, footprints and air at the ends of their numbers.
#include <cmath>
#include <limits>

#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/footprint/footprint_rays.h"
#include "canyon/lidar/beam/footprint/glint_sum.h"
#include "canyon/lidar/beam/pane.h"
#include "canyon/lidar/beam/signal.h"
#include "canyon/lidar/beam/surfaces.h"
#include "canyon/lidar/beam/weather.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/scene.h"
#include "canyon/scene/scene_at.h"

namespace canyon::lidar {
namespace {

using stress::kEpsilon;
using stress::kHalfUlp;

/// Every built-in material at every incidence and wavelength sends back what is finite and not below nothing; of none
/// at grazing incidence more than a Lambertian surface square to the beam could. A figure counts what differs.
StressFigure reflectivities() {
  scene::SceneParts parts;
  parts.name = "materials";
  parts.materials = scene::builtin_materials();
  scene::Material mirror;
  mirror.name = "sharp mirror", mirror.lidar_specular = 1.0, mirror.lidar_specular_lobe_deg = 0.01,
  mirror.lidar_reflectance = 0.0;
  parts.materials.push_back(mirror);
  const scene::Scene scene(std::move(parts));
  StressFigure out;
  for (const double nm : {300.0, 905.0, 2500.0}) {
    const Surfaces surfaces(scene::SceneAt(scene), nm);
    for (std::uint16_t m = 0; m < scene.materials().size(); ++m)
      for (const float c : {0.0f, 1e-38f, 1e-20f, 1e-7f, 1e-3f, 0.1f, 0.7f, 0.999999f, 1.0f}) {
        const float r = surfaces.of_material(m, c), through = surfaces.transmittance(m, c);
        out.figure +=
            std::isfinite(r) && r >= 0.0f && through >= 0.0f && through <= 1.0f && (c > 1e-6f || r <= 1.0f) ? 0.0 : 1.0;
      }
  }
  return out;
}

/// A pane passes its own share at normal incidence, nothing at grazing, and ever less in between. 16 eps.
StressFigure panes(double at_normal) {
  StressFigure out{0.0, 16.0 * kEpsilon};
  take_worst(out, std::abs(pane_transmittance(at_normal, 1.0) - at_normal));
  take_worst(out, std::abs(pane_transmittance(at_normal, 0.0)));
  double before = 0.0;
  for (int k = 1; k <= 10000; ++k) {
    const double now = pane_transmittance(at_normal, k / 10000.0);
    if (!(now >= before && now <= at_normal * (1.0 + 8.0 * kEpsilon)) && at_normal <= 0.918) out.figure = 1.0;
    if (!std::isfinite(now)) out.figure = 1.0;
    before = now;
  }
  return out;
}

/// Sixteen sub-rays of a beam that points anywhere against the spin axis: mean as the beam, standard deviations as
/// asked, unit vectors. Single precision: eight half units, and of the vector across, which near the axis is a
/// difference of equals, its rounding over the sine of the angle times the beam's width.
StressFigure sub_rays(double angle_rad, double sigma_rad) {
  const FootprintOffsets offsets = footprint_offsets(sigma_rad, sigma_rad);
  StressFigure out{0.0, 1.0};
  for (int k = 0; k < 32; ++k) {
    const double turn = 0.2 * k;
    const Eigen::Vector3f up(0.0f, 0.0f, 1.0f);
    const Eigen::Vector3d d(std::sin(angle_rad) * std::cos(turn), std::sin(angle_rad) * std::sin(turn),
                            std::cos(angle_rad));
    scene::RayPacket shots{}, rays{};
    shots.direction_x[5] = static_cast<float>(d.x()), shots.direction_y[5] = static_cast<float>(d.y()),
    shots.direction_z[5] = static_cast<float>(d.z());
    shots.max_m[5] = 100.0f;
    spread_beam(shots, 5, up.data(), offsets, rays);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double square = 0.0;
    const double skew = 8.0 * kHalfUlp / std::max(std::sin(angle_rad), 1e-4) * sigma_rad;
    for (std::size_t i = 0; i < 16; ++i) {
      const Eigen::Vector3d r(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
      take_worst(out, std::abs(r.norm() - 1.0) / (8.0 * kHalfUlp + 3.0 * skew));
      mean += r / 16.0;
      square += (r / r.dot(d) - d).squaredNorm() / 16.0;
    }
    // The mean of sixteen, drawn in by their own spread (sigma^2); the spread, both axes together 2 sigma^2.
    take_worst(out, (mean - d).norm() / (8.0 * kHalfUlp + skew + 1.5 * sigma_rad * sigma_rad));
    take_worst(out, std::abs(std::sqrt(0.5 * square) - sigma_rad) /
                        (16.0 * kHalfUlp + skew + sigma_rad * sigma_rad * sigma_rad));
  }
  return out;
}

/// A beam of which some of its sixteen rays go by an edge to a wall behind, or to nothing: which they are is `mask`'s
/// bits. Nearest and farthest are those of the two surfaces and the brightest is the first of the brighter one, all
/// exact; sums of sixteen in four halvings, of terms of three roundings (reflectivity over square, times a difference
/// of ranges that has one of its own, or times a cosine): eight half units.
StressFigure past_an_edge(unsigned mask, float near_m, float far_m, float overlap_m2) {
  constexpr std::size_t kRays = scene::RayPacket::kRays;
  const auto endless = std::numeric_limits<float>::infinity();
  scene::HitPacket hits{};
  float reflectivity[kRays];
  double power = 0.0, beyond_it = 0.0, cosine = 0.0;
  double most[2] = {-1.0, -1.0};
  int first[2] = {16, 16};
  for (std::size_t i = 0; i < kRays; ++i) {
    const bool far = (mask >> i & 1U) != 0;
    const float range_m = far ? far_m : near_m;
    const bool met = range_m < endless;
    hits.range_m[i] = range_m, hits.cos_incidence[i] = met ? (far ? 0.75f : 0.5f) : 0.0f;
    hits.triangle[i] = met ? 0 : scene::Hit::kMiss;
    reflectivity[i] = met ? (far ? 0.3f : 0.1f) : 0.0f;
    if (!met) continue;
    const double p = reflectivity[i] / worse(double{range_m} * range_m, double{overlap_m2});
    power += p, beyond_it += p * (double{range_m} - (mask == 0xffffU ? far_m : near_m)),
        cosine += p * hits.cos_incidence[i];
    if (first[far] == 16) first[far] = static_cast<int>(i), most[far] = p;
  }
  GlintSum sum;
  sum_glints(hits, reflectivity, overlap_m2, sum);
  stress::Worst worst;
  const auto exactly = [&](bool right) { worst.look(right ? 0.0 : stress::kInfinity, 1.0); };
  const bool any_near = mask != 0xffffU, any_far = mask != 0 && far_m < endless;
  exactly(sum.nearest_m == (any_near ? near_m : far_m));
  exactly(sum.farthest_m == (any_far ? far_m : any_near ? near_m : 0.0f));
  exactly(sum.brightest == (most[1] > most[0] ? first[1] : first[0]));
  worst.look(sum.power - power, 8.0 * kHalfUlp * power + 1e-300);
  worst.look(sum.beyond - beyond_it, 8.0 * kHalfUlp * beyond_it + 1e-300);
  worst.look(sum.cosine - cosine, 8.0 * kHalfUlp * cosine + 1e-300);
  return worst.figure();
}

/// Any air that the keys allow: extinction and the chance of a false return are numbers, the chance within 0 and 1 and
/// rising with the range. A figure counts what is not.
StressFigure air(const WeatherConfig& weather) {
  StressFigure out;
  for (const double overlap : {0.0, 5.0})
    for (const double nm : {300.0, 905.0, 2500.0}) {
      LidarConfig c;
      c.weather = weather;
      c.wavelength_nm = nm;
      c.signal.full_overlap_m = overlap;
      c.report.min_range_m = 0.0;
      const Weather model(c, 1);
      out.figure += std::isfinite(model.extinction_1_m()) && model.extinction_1_m() >= 0.0 &&
                            std::isfinite(model.backscatter_1_m_sr())
                        ? 0.0
                        : 1.0;
      double before = 0.0;
      for (const double r : {0.0, 1e-9, 1.0, 30.0, 99.0, 1e9}) {
        const double p = model.false_return_probability(r);
        out.figure += p >= before && p <= 1.0 ? 0.0 : 1.0;
        before = p;
      }
      Volley volley;
      volley.lasers = 1, volley.cycles = Volley::kCycles;
      volley.rays.resize(volley.packets());
      for (auto& packet : volley.rays) std::fill_n(packet.max_m, 16, 100.0f);
      Echoes echoes;
      for (EchoPacket& packet : echoes.start(volley.packets()))
        for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
          packet.set(i, i % 4 == 0 ? Echo{} : Echo{{i % 4 == 1 ? 0.0f : 40.0f, 1.0f, 0, 0}, i % 4 == 2 ? 0.0f : 0.5f});
      model.apply(volley, echoes);
      for (std::size_t k = 0; k < echoes.layers(); ++k)
        for (const EchoPacket& packet : echoes.layer(k))
          for (std::size_t i = 0; i < EchoPacket::kShots; ++i)
            if (packet.range_m[i] < std::numeric_limits<float>::infinity())
              out.figure +=
                  packet.range_m[i] >= 0.0f && std::isfinite(packet.reflectivity[i]) && packet.reflectivity[i] >= 0.0f
                      ? 0.0
                      : 1.0;
    }
  return out;
}

/// Energy from no distance on: constant up to full overlap, then by the square; 10 at range_at_10_percent. 8 eps.
StressFigure gain() {
  StressFigure out{0.0, 8.0 * kEpsilon};
  for (const double overlap : {0.0, 5.0, 1e3}) {
    SignalConfig c;
    c.full_overlap_m = overlap;
    const double least = std::max(overlap, 0.01);
    for (const double r : {0.0, 1e-300, 1e-3, 1.0, 50.0, 1e5, 1e30}) {
      const double exact = 10.0 * 50.0 * 50.0 / std::pow(worse(r, least), 2);
      take_worst(out, std::abs(signal_gain(c, r) / exact - 1.0));
    }
  }
  return out;
}

}  // namespace

std::vector<StressCase> light_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "reflectivity from grazing to square incidence",
           "cos^5 under a fraction, exp of minus infinity times infinity",
           "finite, not negative; at grazing no more than Lambertian", "wrong"});
  rows.add("light/materials_at_all_incidences", reflectivities);
  rows.of({StressGroup::kGeometry, "a pane from grazing to square incidence",
           "a power of nothing, an absorption of more than all",
           "its own share at normal incidence, none at grazing: 16 eps", ""});
  for (const double share : {0.0, 1e-12, 0.5, 0.918, 1.0}) {
    rows.add(printed("light/pane_of_%g", share), [share] { return panes(share); });
  }
  rows.of({StressGroup::kGeometry, "a beam's sub-rays about the spin axis",
           "up x direction vanishes: no direction across the beam",
           "mean, spread and length as asked, to single precision over the sine of the angle", "of the bound"});
  struct Width {
    double angle, sigma;
    const char* name;
  };
  for (const Width& b :
       {Width{0.5 * kPi, 7.5e-4, "square_to_the_axis"}, Width{0.0, 7.5e-4, "along_the_axis"},
        Width{kPi, 7.5e-4, "against_the_axis"}, Width{1.01e-4, 7.5e-4, "just_beside_the_axis"},
        Width{1e-6, 7.5e-4, "a_rounding_off_the_axis"}, Width{1.0, 0.025, "wide"}, Width{1.0, 0.0, "without_width"}})
    rows.add(std::string("light/beam_") + b.name, [b] { return sub_rays(b.angle, b.sigma); });
  rows.of({StressGroup::kGeometry, "a beam of which a part goes by an edge",
           "the first ray's range for all of them; infinity less infinity of rays that meet nothing",
           "nearest, farthest and brightest exact, sums to eight half units", "of the bound"});
  for (const unsigned mask : {0x0000U, 0x0001U, 0x8000U, 0x5a3cU, 0xfffeU, 0xffffU}) {
    rows.add(printed("light/edge_%04x_before_a_wall", mask),
             [mask] { return past_an_edge(mask, 12.3f, 13.1f, 25.0f); });
    rows.add(printed("light/edge_%04x_before_nothing", mask),
             [mask] { return past_an_edge(mask, 3.7f, std::numeric_limits<float>::infinity(), 25.0f); });
  }
  rows.of({StressGroup::kStiff, "air from none to solid",
           "a visibility next to nothing: infinite extinction times no light",
           "numbers; a chance within 0 and 1 that rises with the range", "wrong"});
  const auto weather = [](const char* key, double amount) {
    WeatherConfig w;
    const std::string k = key;
    if (k == "rain") w.rain_mm_h = amount;
    if (k == "fog") w.fog_visibility_m = amount;
    if (k == "snow") w.snow_mm_h = amount;
    if (k == "dust") w.dust_visibility_m = amount;
    return w;
  };
  for (const char* key : {"rain", "fog", "snow", "dust"})
    for (const double amount : {0.0, 1e-300, 1e-3, 1.0, 100.0}) {
      rows.add(printed("light/%s_of_%g", key, amount), [w = weather(key, amount)] { return air(w); });
    }
  rows.of({StressGroup::kGeometry, "energy from no distance to an endless one", "a division by the square of nothing",
           "closed form, 8 eps", ""});
  rows.add("light/gain_from_no_distance", gain);
  return rows.take();
}

}  // namespace canyon::lidar
