// What becomes of a volley's echoes after they were met: the air, other sensors, the receiver, the report.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/beam/no_surface.h"
#include "canyon/lidar/beam/weather.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/receiver/crosstalk.h"
#include "canyon/lidar/receiver/sensor_report.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using stress::kHalfUlp;
using stress::kInfinity;
using stress::Looks;
constexpr float kNoEcho = std::numeric_limits<float>::infinity();
constexpr std::size_t kLanes = Volley::kLanes;

/// Shots of some lasers, aimed anywhere, of which some are not fired, and their echoes: up to `layers` of each, in the
/// order of range, some shots with fewer and some with none.
struct DrawnVolley {
  Volley volley;
  Echoes echoes;
};
DrawnVolley drawn_volley(std::uint64_t number, std::size_t lasers, std::size_t layers) {
  const RandomStream draws(number, "stress.volleys");
  DrawnVolley out;
  Volley& v = out.volley;
  v.lasers = lasers, v.cycles = 29, v.first_cycle = 64, v.first_draw = 1000 + 64, v.first_s = -0.0015, v.step_s = 5e-5;
  v.aims.resize(v.packets()), v.rays.resize(v.packets());
  for (std::size_t shot = 0; shot < v.shots(); ++shot) {
    AimPacket& aim = v.aims[shot / kLanes];
    const std::size_t i = shot % kLanes;
    const Eigen::Vector3d d = draws.direction(0, shot), o = 0.05 * draws.normal3(shot, 7);
    aim.direction_x[i] = static_cast<float>(d.x()), aim.direction_y[i] = static_cast<float>(d.y());
    aim.direction_z[i] = static_cast<float>(d.z()), aim.origin_x[i] = static_cast<float>(o.x());
    aim.origin_y[i] = static_cast<float>(o.y()), aim.origin_z[i] = static_cast<float>(o.z());
    v.rays[shot / kLanes].max_m[i] = draws.uniform(1, shot) < 0.1 ? -1.0f : 100.0f;
  }
  for (EchoPacket& packet : out.echoes.start(v.packets()))
    for (std::size_t i = 0; i < kLanes; ++i) packet.set(i, {});
  for (std::size_t shot = 0; shot < v.shots(); ++shot) {
    if (v.rays[shot / kLanes].max_m[shot % kLanes] < 0.0f) continue;
    const auto count = static_cast<std::size_t>(draws.uniform(2, shot) * (static_cast<double>(layers) + 0.999));
    for (std::uint32_t k = 0; k < count; ++k) {
      const double range_m = 2.0 + 80.0 * std::pow(draws.uniform(3 + k, shot), 2);
      out.echoes.insert(shot, {{static_cast<float>(range_m), static_cast<float>(draws.uniform(0.1, 1.0, 20 + k, shot)),
                                static_cast<std::uint16_t>(k), static_cast<std::uint32_t>(shot)},
                               static_cast<float>(draws.uniform(0.02, 1.2, 40 + k, shot))});
    }
  }
  return out;
}

/// The echoes of a shot, nearest first.
std::vector<Echo> echoes_of(const Echoes& echoes, std::size_t shot) {
  std::vector<Echo> out;
  for (std::size_t k = 0; k < echoes.layers(); ++k)
    if (const Echo e = echoes.layer(k)[shot / kLanes].at(shot % kLanes); e.any()) out.push_back(e);
  return out;
}

/// Extinction from the published laws, each by itself: Marshall and Palmer's 3.6e-4 R^0.63 per metre, Carbonneau's
/// 1.076 R^0.67 dB/km, Goodin's 0.01 R^0.6 per metre; Koschmieder's 3.912 / V with Kruse's and Kim's exponents of the
/// wavelength over 550 nm; ITU-R P.1817 table 2; and dust's 52 V^-1.05 dB/km.
double published_extinction(const WeatherConfig& w, double nm, double& backscatter) {
  const auto per_m = [](double db_km) { return db_km * std::log(10.0) / 10.0 / 1000.0; };
  const auto visibility = [](const std::string& law, double m) {
    const double km = m / 1000.0;
    if (km > 50.0) return 1.6;
    if (km > 6.0) return 1.3;
    if (law == "kruse") return 0.585 * std::pow(km, 1.0 / 3.0);
    if (km > 1.0) return 0.16 * km + 0.34;
    return km > 0.5 ? km - 0.5 : 0.0;
  };
  double rain = 0.0, fog = 0.0, snow = 0.0, dust = 0.0;
  if (w.rain_mm_h > 0.0)
    rain = w.rain_law == "marshall_palmer" ? 3.6e-4 * std::exp(0.63 * std::log(w.rain_mm_h))
           : w.rain_law == "carbonneau"    ? per_m(1.076 * std::exp(0.67 * std::log(w.rain_mm_h)))
                                           : 0.01 * std::exp(0.6 * std::log(w.rain_mm_h));
  if (w.fog_visibility_m > 0.0)
    fog = 3.912 / w.fog_visibility_m * std::exp(-visibility(w.fog_law, w.fog_visibility_m) * std::log(nm / 550.0));
  if (w.snow_mm_h > 0.0)
    snow = w.snow_law == "wet" ? per_m((1.023e-4 * nm + 3.7855466) * std::exp(0.72 * std::log(w.snow_mm_h)))
                               : per_m((5.42e-5 * nm + 5.4958776) * std::exp(1.38 * std::log(w.snow_mm_h)));
  if (w.dust_visibility_m > 0.0) dust = per_m(52.0 * std::exp(-1.05 * std::log(w.dust_visibility_m / 1000.0)));
  backscatter = (rain + fog) / 18.8 + snow / 20.0 + dust / 50.0;
  return rain + fog + snow + dust;
}

/// Weather by its documentation: extinction and backscatter of all that is in the air, every echo weaker by the way
/// there and back, and the first cell of a pulse's length that answers, from the documented stream. Powers to 16 eps,
/// a product over 150 cells to two of each; what is told in single precision to four of its halves.
StressFigure air_by_its_laws(const WeatherConfig& weather, double nm, bool answers) {
  Looks looks;
  LidarConfig config;
  config.weather = weather, config.wavelength_nm = nm;
  config.weather.false_returns = answers;
  config.report.min_range_m = 1.3, config.report.max_range_m = 91.0;
  config.signal.pulse_m = 0.6, config.signal.range_at_10_percent_m = 70.0, config.signal.full_overlap_m = 4.0;
  const Weather air(config, 11);
  double beta = 0.0;
  const double alpha = published_extinction(weather, nm, beta);
  looks.near(air.extinction_1_m() / alpha, 1.0, 16.0 * stress::kEpsilon);
  looks.near(air.backscatter_1_m_sr() / beta, 1.0, 16.0 * stress::kEpsilon);
  looks.right(!air.clear() && Weather(LidarConfig{}, 1).clear());
  const auto mean = [&](double r) {
    const double ratio = 70.0 / (r > 4.0 ? r : 4.0);
    return kPi * beta * 0.6 * 10.0 * ratio * ratio * std::exp(-2.0 * alpha * r);
  };
  // Chances that one of the first cells answers.
  std::vector<double> answered{0.0};
  const int cells = static_cast<int>(std::ceil((91.0 - 1.3) / 0.6 - 1e-9));
  for (int k = 0; k < cells; ++k)
    answered.push_back(1.0 - (1.0 - answered.back()) * (1.0 - std::exp(-1.0 / mean(1.3 + 0.6 * (k + 0.5)))));
  for (double r = 0.1; r < 120.0; r += 0.37) {
    const double at = (r - 1.3) / 0.6;
    const int k = at > 0.0 ? static_cast<int>(at) : 0;
    const double expected =
        at <= 0.0   ? 0.0
        : k < cells ? answered[static_cast<std::size_t>(k)] +
                          (at - k) * (answered[static_cast<std::size_t>(k) + 1] - answered[static_cast<std::size_t>(k)])
                    : answered.back();
    looks.near(air.false_return_probability(r), answers ? expected : 0.0, 300.0 * stress::kEpsilon);
  }
  DrawnVolley drawn = drawn_volley(3, 5, 2);
  const Echoes before = drawn.echoes;
  air.apply(drawn.volley, drawn.echoes);
  const RandomStream stream(11, "lidar.weather");
  int returned = 0;
  for (std::size_t shot = 0; shot < drawn.volley.shots(); ++shot) {
    std::vector<Echo> expected = echoes_of(before, shot);
    for (Echo& e : expected)
      e.reflectivity *= static_cast<float>(std::exp(-2.0 * alpha * static_cast<double>(e.truth.range_m)));
    const auto laser = static_cast<std::uint32_t>(shot / 32);
    const std::uint64_t draw = drawn.volley.first_draw + shot % 32;
    const double u = stream.uniform(laser, draw, 0);
    const float reach = drawn.volley.rays[shot / kLanes].max_m[shot % kLanes];
    std::size_t cell = 0;
    while (cell < static_cast<std::size_t>(cells) && answered[cell + 1] <= u) ++cell;
    if (answers && reach > 0.0f && cell < static_cast<std::size_t>(cells)) {
      const double r = 1.3 + 0.6 * (static_cast<double>(cell) + stream.uniform(laser, draw, 1));
      const double surface = expected.empty() ? 100.0 : static_cast<double>(expected[0].truth.range_m);
      const double ratio = 70.0 / (r > 4.0 ? r : 4.0);
      const double signal = 1.0 - mean(r) * std::log(1.0 - stream.uniform(laser, draw, 2));
      if (r < surface) {
        expected.insert(expected.begin(), {{static_cast<float>(r), 1.0f, kNoMaterial, kNoObject},
                                           static_cast<float>(signal / (10.0 * ratio * ratio))});
        ++returned;
      }
    }
    const std::vector<Echo> found = echoes_of(drawn.echoes, shot);
    looks.right(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size() && k < expected.size(); ++k) {
      const Echo &f = found[k], &e = expected[k];
      looks.near(f.truth.range_m, e.truth.range_m, 4.0 * kHalfUlp * 100.0);
      looks.near(f.reflectivity, e.reflectivity, 8.0 * kHalfUlp * static_cast<double>(e.reflectivity) + 1e-30);
      looks.right(f.truth.material == e.truth.material && f.truth.object == e.truth.object &&
                  f.truth.cos_incidence == e.truth.cos_incidence);
    }
  }
  looks.right(answers ? returned > 0 : returned == 0);
  return looks.figure();
}

/// Pulses of others by the documented stream: whether, where and how strong, one more echo of a shot that was fired.
StressFigure others_by_their_stream() {
  Looks looks;
  LidarConfig config;
  config.crosstalk.probability = 0.3, config.report.min_range_m = 2.5, config.report.max_range_m = 66.0;
  config.signal.range_at_10_percent_m = 31.0;
  DrawnVolley drawn = drawn_volley(5, 4, 1);
  const Echoes before = drawn.echoes;
  Crosstalk(config, 17).apply(drawn.volley, drawn.echoes);
  const RandomStream stream(17, "lidar.crosstalk");
  int more = 0;
  for (std::size_t shot = 0; shot < drawn.volley.shots(); ++shot) {
    std::vector<Echo> expected = echoes_of(before, shot);
    const auto laser = static_cast<std::uint32_t>(shot / 32);
    const std::uint64_t draw = drawn.volley.first_draw + shot % 32;
    if (drawn.volley.rays[shot / kLanes].max_m[shot % kLanes] >= 0.0f && stream.uniform(laser, draw, 0) < 0.3) {
      const double r = 2.5 + 63.5 * stream.uniform(laser, draw, 1), s = 1.0 + 9.0 * stream.uniform(laser, draw, 2);
      const double ratio = 31.0 / (r > 5.0 ? r : 5.0);
      expected.push_back(
          {{static_cast<float>(r), 1.0f, kNoMaterial, kNoObject}, static_cast<float>(s / (10.0 * ratio * ratio))});
      std::stable_sort(expected.begin(), expected.end(),
                       [](const Echo& a, const Echo& b) { return a.truth.range_m < b.truth.range_m; });
      ++more;
    }
    const std::vector<Echo> found = echoes_of(drawn.echoes, shot);
    looks.right(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size() && k < expected.size(); ++k) {
      looks.near(found[k].truth.range_m, expected[k].truth.range_m, 4.0 * kHalfUlp * 100.0);
      looks.near(found[k].reflectivity, expected[k].reflectivity,
                 8.0 * kHalfUlp * static_cast<double>(expected[k].reflectivity));
      looks.right(found[k].truth.material == expected[k].truth.material &&
                  found[k].truth.cos_incidence == expected[k].truth.cos_incidence);
    }
  }
  looks.right(more > 20);
  return looks.figure();
}

LidarConfig of_keys(const std::string& keys) {
  LidarConfig config;
  const auto node = ConfigNode::parse(keys, "keys");
  if (!node.ok() || !read_config(&*node, "lidar", config).ok()) config.detector.name = "keys that are none";
  return config;
}

/// Both detectors by their documentation, each echo of each layer with the draws of its own: signal and its noise, the
/// edge's and the range's, intensity, saturation. A few roundings of single precision.
StressFigure detectors_by_their_streams(bool radiometric) {
  Looks looks;
  const double snr = 4.0, walk_m = 0.3;
  const LidarConfig config =
      of_keys(radiometric ? "detector = \"radiometric\"\nthreshold_snr = 4.0\nsaturation = 20.0\n"
                            "saturation_walk_m = 0.3\nrange_noise_m = 0.03\npulse_m = 0.9\n"
                            "range_at_10_percent_m = 25.0\nfull_overlap_m = 6.0\n"
                          : "detector = \"ideal\"\nrange_noise_m = 0.03\n");
  auto detector = config.detector.make("detector", config, std::uint64_t{23});
  looks.right(detector.ok());
  if (!detector) return looks.figure();
  looks.near((*detector)->weakest_edge_m(), radiometric ? 0.9 / (2.0 * snr) : 0.0, 1e-15);
  DrawnVolley drawn = drawn_volley(6, 6, 3);
  (*detector)->detect(drawn.volley, drawn.echoes);
  const RandomStream range(23, "lidar.range"), noise(23, "lidar.signal");
  int detected = 0, clipped = 0, missed = 0;
  for (std::size_t k = 0; k < drawn.echoes.layers(); ++k)
    for (std::size_t shot = 0; shot < drawn.volley.shots(); ++shot) {
      const EchoPacket& packet = drawn.echoes.layer(k)[shot / kLanes];
      const std::size_t i = shot % kLanes;
      const auto laser = static_cast<std::uint32_t>(shot / 32), n = static_cast<std::uint32_t>(k);
      const std::uint64_t draw = drawn.volley.first_draw + shot % 32;
      const double r = packet.range_m[i], rho = packet.reflectivity[i];
      if (packet.range_m[i] == kNoEcho) {
        looks.right(packet.measured_m[i] == 0.0f || packet.measured_m[i] == kNoEcho);
        continue;
      }
      if (!radiometric) {
        looks.near(packet.measured_m[i], r + 0.03 * range.normal(laser, draw, n), 2.0 * kHalfUlp * 100.0);
        looks.near(packet.intensity[i], rho < 1.0 ? rho : 1.0, 1e-300);
        ++detected;
        continue;
      }
      const double ratio = 25.0 / (r > 6.0 ? r : 6.0), gain = 10.0 * ratio * ratio, signal = rho * gain;
      const double received = signal + noise.normal(laser, draw, n) / snr;
      if (std::abs(received - 1.0) < 1e-9) continue;
      if (received <= 1.0) {
        looks.right(packet.measured_m[i] == 0.0f && packet.intensity[i] == 0.0f);
        ++missed;
        continue;
      }
      const double edge = 0.9 / (2.0 * snr * (signal > 1.0 ? signal : 1.0));
      double expected = r + std::hypot(0.03, edge) * range.normal(laser, draw, n);
      if (signal > 20.0) expected -= walk_m * std::log10(signal / 20.0), ++clipped;
      looks.near(packet.measured_m[i], expected, 2.0 * kHalfUlp * 100.0);
      looks.near(packet.intensity[i], received / gain < 1.0 ? received / gain : 1.0, 2.0 * kHalfUlp);
      ++detected;
    }
  looks.right(detected > 100 && (!radiometric || (clipped > 10 && missed > 10)));
  return looks.figure();
}

/// Which of a shot's echoes are told, by what the modes say.
std::vector<std::size_t> told(ReturnMode mode, const std::vector<double>& strengths) {
  std::vector<std::size_t> out;
  if (strengths.empty()) return out;
  std::size_t strongest = 0;
  for (std::size_t k = 0; k < strengths.size(); ++k)
    if (strengths[k] > strengths[strongest]) strongest = k;
  const std::size_t last = strengths.size() - 1;
  if (mode == ReturnMode::kStrongest) out = {strongest};
  if (mode == ReturnMode::kFirst) out = {0};
  if (mode == ReturnMode::kLast) out = {last};
  if (mode == ReturnMode::kAll)
    for (std::size_t k = 0; k <= last; ++k) out.push_back(k);
  if (mode != ReturnMode::kDual) return out;
  std::size_t other = last;
  if (strongest == last) {
    if (last == 0) return {0};
    other = 0;
    for (std::size_t k = 0; k < last; ++k)
      if (strengths[k] > strengths[other]) other = k;
  }
  out = {std::min(strongest, other), strongest < other ? other : strongest};
  return out;
}

/// The report of a volley by its documentation: each detected echo with the bias of its laser in whole quanta, within
/// the limits, chosen by the mode, along the nominal beam; in the order of firing, at the laser's own time. Single
/// precision of 100 m.
StressFigure reports(ReturnMode mode, std::size_t layers, double quantum_m) {
  Looks looks;
  const auto table = load_beam_table("vlp16");
  looks.right(table.ok());
  if (!table) return looks.figure();
  const FiringPattern pattern(*table, 10.0, 1800);
  LidarConfig config;
  config.report = {
      .returns = mode, .min_range_m = 4.0, .max_range_m = 60.0, .range_quantum_m = quantum_m, .range_bias_m = 0.2};
  config.signal.full_overlap_m = 12.0;
  const SensorReport report(config.report, config.signal, pattern, 29);
  DrawnVolley drawn = drawn_volley(7, 16, layers);
  const RandomStream draws(8, "stress.measured"), bias(29, "lidar.range_bias");
  for (std::size_t k = 0; k < drawn.echoes.layers(); ++k)
    for (std::size_t shot = 0; shot < drawn.volley.shots(); ++shot) {
      EchoPacket& packet = drawn.echoes.layer(k)[shot / kLanes];
      const std::size_t i = shot % kLanes;
      const bool some = packet.range_m[i] < kNoEcho && draws.uniform(0, shot, static_cast<std::uint32_t>(k)) < 0.8;
      packet.measured_m[i] = some ? packet.range_m[i] : 0.0f;
      packet.intensity[i] = some ? static_cast<float>(draws.uniform(1, shot, static_cast<std::uint32_t>(k))) : 0.0f;
      // Beyond the sweep nothing is fired.
      if (shot % 32 >= drawn.volley.cycles) packet.measured_m[i] = 0.0f;
    }
  VolleyReturns returns;
  report.choose(drawn.volley, drawn.echoes, returns);
  std::vector<LidarPoint> points(returns.total);
  std::vector<LidarPointTruth> truth(returns.total);
  report.write(returns, points, truth);
  std::size_t at = 0;
  std::vector<std::size_t> order;
  for (std::size_t laser = 0; laser < 16; ++laser) order.push_back(laser);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table->beams[a].firing_s < table->beams[b].firing_s; });
  for (std::size_t cycle = 0; cycle < drawn.volley.cycles; ++cycle)
    for (const std::size_t laser : order) {
      const std::size_t shot = laser * 32 + cycle, p = shot / kLanes, i = shot % kLanes;
      std::vector<double> ranges, strengths;
      std::vector<std::size_t> of_layer;
      for (std::size_t k = 0; k < drawn.echoes.layers(); ++k) {
        const EchoPacket& packet = drawn.echoes.layer(k)[p];
        const double biased = packet.measured_m[i] + 0.2 * bias.normal(static_cast<std::uint32_t>(laser), 0);
        const double range = quantum_m > 0.0 ? std::nearbyint(biased / quantum_m) * quantum_m : biased;
        if (!(packet.measured_m[i] > 0.0f) || range < 4.0 || range > 60.0) continue;
        const double square = static_cast<double>(packet.range_m[i]) * static_cast<double>(packet.range_m[i]);
        ranges.push_back(range), of_layer.push_back(k);
        strengths.push_back(packet.reflectivity[i] / (square > 144.0 ? square : 144.0));
      }
      const auto chosen = told(mode, strengths);
      for (std::size_t n = 0; n < chosen.size(); ++n, ++at) {
        if (at >= points.size()) break;
        const EchoPacket& packet = drawn.echoes.layer(of_layer[chosen[n]])[p];
        const AimPacket& aim = drawn.volley.aims[p];
        const double range = ranges[chosen[n]];
        const double grain = 4.0 * kHalfUlp * 60.0;
        looks.near(points[at].x, aim.origin_x[i] + range * static_cast<double>(aim.direction_x[i]), grain);
        looks.near(points[at].y, aim.origin_y[i] + range * static_cast<double>(aim.direction_y[i]), grain);
        looks.near(points[at].z, aim.origin_z[i] + range * static_cast<double>(aim.direction_z[i]), grain);
        looks.right(points[at].intensity == packet.intensity[i] && points[at].ring == laser &&
                    points[at].return_index == n);
        const double time =
            drawn.volley.first_s + static_cast<double>(cycle) * drawn.volley.step_s + table->beams[laser].firing_s;
        looks.near(points[at].time_s, time < 0.0 ? time : 0.0, 2.0 * kHalfUlp * 0.002);
        looks.right(truth[at].range_m == packet.range_m[i] && truth[at].material == packet.truth[i].material &&
                    truth[at].object == packet.truth[i].object &&
                    truth[at].cos_incidence == packet.truth[i].cos_incidence);
      }
    }
  looks.right(at == points.size() && at > 100);
  looks.right(report.most_returns() == (mode == ReturnMode::kAll ? 0U : mode == ReturnMode::kDual ? 2U : 1U));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> volley_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what is in the air, from laws to echoes",
           "a law's power, a decibel for a neper, one way in place of two, a cell's end for its middle",
           "published laws, and cell by cell from the documented stream: roundings", "of the bound"});
  struct Air {
    const char* name;
    WeatherConfig weather;
    double nm;
  };
  for (const Air& air :
       {Air{"rain", {.rain_mm_h = 20.0}, 905.0},
        Air{"rain_carbonneau", {.rain_mm_h = 80.0, .rain_law = "carbonneau"}, 905.0},
        Air{"rain_goodin", {.rain_mm_h = 5.0, .rain_law = "goodin_2019"}, 1550.0},
        Air{"fog", {.fog_visibility_m = 300.0}, 905.0},
        Air{"haze", {.rain_mm_h = 2.0, .fog_visibility_m = 9e3}, 1550.0},
        Air{"clear_air", {.rain_mm_h = 3.0, .fog_visibility_m = 6e4}, 1550.0},
        Air{"fog_kim", {.fog_visibility_m = 400.0, .fog_law = "kim"}, 1550.0},
        Air{"fog_kim_of_700_m", {.fog_visibility_m = 700.0, .fog_law = "kim"}, 1550.0},
        Air{"mist_kim", {.rain_mm_h = 4.0, .fog_visibility_m = 3e3, .fog_law = "kim"}, 850.0},
        Air{"haze_kim", {.rain_mm_h = 4.0, .fog_visibility_m = 9e3, .fog_law = "kim"}, 850.0},
        Air{"clear_air_kim", {.rain_mm_h = 4.0, .fog_visibility_m = 6e4, .fog_law = "kim"}, 850.0},
        Air{"wet_snow", {.snow_mm_h = 3.0}, 905.0}, Air{"dry_snow", {.snow_mm_h = 3.0, .snow_law = "dry"}, 1550.0},
        Air{"dust", {.dust_visibility_m = 500.0}, 905.0},
        Air{"all", {.rain_mm_h = 9.0, .fog_visibility_m = 2e3, .snow_mm_h = 1.0, .dust_visibility_m = 3e3}, 905.0}})
    rows.add(std::string("volleys/air_of_") + air.name, [air] { return air_by_its_laws(air.weather, air.nm, true); });
  rows.add("volleys/air_that_does_not_answer",
           [] { return air_by_its_laws({.rain_mm_h = 20.0, .dust_visibility_m = 800.0}, 905.0, false); });
  rows.of({StressGroup::kData, "echoes from others to detection, one by one",
           "draws of another shot or layer, a variance for a sigma, a threshold on the signal without its noise",
           "each echo by the documentation, from the documented streams: single precision", "of the bound"});
  rows.add("volleys/pulses_of_others", others_by_their_stream)
      .add("volleys/ideal_detector", [] { return detectors_by_their_streams(false); })
      .add("volleys/radiometric_detector", [] { return detectors_by_their_streams(true); });
  rows.of({StressGroup::kData, "what a sensor tells of its echoes",
           "a bias of another laser, a limit before the quantum, layers in each other's place, times of another cycle",
           "each return by the documentation, in the order of firing: single precision", "of the bound"});
  const std::pair<const char*, ReturnMode> modes[] = {{"strongest", ReturnMode::kStrongest},
                                                      {"first", ReturnMode::kFirst},
                                                      {"last", ReturnMode::kLast},
                                                      {"dual", ReturnMode::kDual},
                                                      {"all", ReturnMode::kAll}};
  for (const auto& [name, mode] : modes) {
    rows.add(std::string("volleys/report_of_") + name, [mode = mode] { return reports(mode, 4, 0.004); });
    rows.add(std::string("volleys/report_of_one_layer_") + name, [mode = mode] { return reports(mode, 1, 0.0); });
  }
  return rows.take();
}

}  // namespace canyon::lidar
