// The image method against a search that shares nothing with it: every sequence of rectangles is tried, the wave's
// direction mirrored back along it, and the ray walked forward from the antenna in double precision.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/gnss/paths/path_model.h"
#include "canyon/scene/city/city.h"
#include "canyon/scene/scene_at.h"
#include "canyon/tests/gnss/paths/wall_scene.h"

namespace canyon::gnss {
namespace {

using testing::WallScene;

struct Rectangle {
  Eigen::Vector3d corner, u, v, n;
};

/// Boxes whose corners are exact in single precision, turned by rotations with rational entries.
class RandomBoxes {
 public:
  RandomBoxes(std::uint64_t seed, int boxes, bool upright) {
    const RandomStream random(seed, "test.boxes");
    WallScene scene;
    for (int b = 0; b < boxes; ++b) {
      std::uint64_t draw = 0;
      const auto entity = static_cast<std::uint64_t>(b);
      const auto whole = [&](int low, int high) {
        return low + static_cast<int>(random.uniform(0.0, high - low + 1.0, entity, draw++));
      };
      const int qw = whole(1, 3), qx = upright ? 0 : whole(-1, 1), qy = upright ? 0 : whole(-1, 1), qz = whole(-3, 3);
      const double n = qw * qw + qx * qx + qy * qy + qz * qz;
      Eigen::Matrix3d r;  // n times a rotation: whole numbers
      r << qw * qw + qx * qx - qy * qy - qz * qz, 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy),
          2 * (qx * qy + qw * qz), qw * qw - qx * qx + qy * qy - qz * qz, 2 * (qy * qz - qw * qx),
          2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), qw * qw - qx * qx - qy * qy + qz * qz;
      // Around the antenna, seldom over it.
      const double bearing = random.uniform(0.0, 2.0 * kPi, entity, 100), away_m = random.uniform(15, 60, entity, 101);
      const Eigen::Vector3d origin(std::round(away_m * std::cos(bearing)), std::round(away_m * std::sin(bearing)),
                                   upright ? -2 : whole(-15, 10));
      const double unit = 0.25;
      const auto edge = [&](int column, double length_m) -> Eigen::Vector3d {
        return r.col(column) * (unit * std::max(1.0, std::round(length_m / (n * unit))));
      };
      add_box(origin, edge(0, whole(20, 90)), edge(1, whole(5, 30)), edge(2, whole(20, 90)), scene);
    }
    scene_ = scene.build();
  }

  const scene::Scene& scene() const { return *scene_; }
  const std::vector<Rectangle>& rectangles() const { return rectangles_; }

  /// Index of the rectangle that a facet is.
  std::size_t rectangle_of(const scene::Facet& facet) const {
    for (std::size_t i = 0; i < rectangles_.size(); ++i) {
      const Rectangle& r = rectangles_[i];
      if ((r.corner + 0.5 * (r.u + r.v) - facet.center_W).norm() < 1e-9 && r.n.dot(facet.normal_W) > 0.999) return i;
    }
    ADD_FAILURE() << "a facet that is no rectangle of the test";
    return 0;
  }

 private:
  void add_box(const Eigen::Vector3d& o, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               WallScene& scene) {
    const auto add = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
      scene.wall(corner, u, v, "metal");
      rectangles_.push_back({corner, u, v, u.cross(v).normalized()});
    };
    add(o, b, a), add(o + c, a, b), add(o, a, c), add(o + b, c, a), add(o, c, b), add(o + a, b, c);
  }

  std::vector<Rectangle> rectangles_;
  std::unique_ptr<scene::Scene> scene_;
};

constexpr double kEdge_m = 0.006;  // nearer than this to an edge, either answer is right

/// Where the ray meets the plane of the rectangle, grown on all sides; the range, or nullopt.
std::optional<double> meet(const Rectangle& r, const Eigen::Vector3d& from, const Eigen::Vector3d& towards,
                           double grown_m) {
  const double approach = r.n.dot(towards);
  if (std::abs(approach) < 1e-12) return std::nullopt;
  const double range = r.n.dot(r.corner - from) / approach;
  if (range <= 0.0) return std::nullopt;
  const Eigen::Vector3d q = from + range * towards - r.corner;
  const double u = q.dot(r.u) / r.u.norm(), v = q.dot(r.v) / r.v.norm();
  const bool inside = u >= -grown_m && v >= -grown_m && u <= r.u.norm() + grown_m && v <= r.v.norm() + grown_m;
  return inside ? std::optional(range) : std::nullopt;
}

bool blocked(const std::vector<Rectangle>& all, const Eigen::Vector3d& from, const Eigen::Vector3d& towards,
             double length_m, double grown_m, std::size_t skip0, std::size_t skip1) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == skip0 || i == skip1) continue;
    const auto range = meet(all[i], from, towards, grown_m);
    if (range && *range < length_m) return true;
  }
  return false;
}

using Key = std::vector<std::size_t>;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The way over the sequence; its excess, or nullopt. `grown_m` > 0: reflectors grown, obstacles shrunk, so that all
/// doubtful ways are there; < 0: none of them.
std::optional<double> walk(const std::vector<Rectangle>& all, const Key& sequence, const Eigen::Vector3d& antenna,
                           const Eigen::Vector3d& s, double grown_m) {
  Eigen::Vector3d towards = s;
  for (std::size_t j = sequence.size(); j-- > 0;) {
    const Eigen::Vector3d& n = all[sequence[j]].n;
    towards -= 2.0 * n.dot(towards) * n;
  }
  Eigen::Vector3d at = antenna;
  double length_m = 0.0;
  std::size_t left = kNone;
  for (const std::size_t i : sequence) {
    if (all[i].n.dot(towards) >= 0.0) return std::nullopt;
    const auto range = meet(all[i], at, towards, grown_m);
    if (!range || blocked(all, at, towards, *range, -grown_m, left, i)) return std::nullopt;
    at += *range * towards;
    length_m += *range;
    towards -= 2.0 * all[i].n.dot(towards) * all[i].n;
    left = i;
  }
  if (blocked(all, at, towards, 1e9, -grown_m, left, kNone)) return std::nullopt;
  return length_m - (at - antenna).dot(s);
}

void all_sequences(std::size_t rectangles, int order, Key& prefix, std::vector<Key>& out) {
  if (!prefix.empty()) out.push_back(prefix);
  if (static_cast<int>(prefix.size()) == order) return;
  for (std::size_t i = 0; i < rectangles; ++i) {
    if (!prefix.empty() && prefix.back() == i) continue;
    prefix.push_back(i);
    all_sequences(rectangles, order, prefix, out);
    prefix.pop_back();
  }
}

PathParameters everything() {
  PathParameters p;
  p.cutoff_m = 1e9;
  p.weakest_db = p.weakest_nlos_db = -300.0;
  p.finite_facets = false;
  p.combine_all_m = 1e6;
  return p;
}

struct Outcome {
  int certain = 0, doubtful = 0, per_order[4] = {};
};

void compare(const RandomBoxes& boxes, int order, const PathParameters& parameters, std::uint64_t seed,
             Outcome& outcome) {
  const RandomStream random(seed, "test.satellites");
  std::vector<Eigen::Vector3d> directions;
  for (std::uint64_t i = 0; i < 40; ++i)
    directions.push_back(testing::direction(random.uniform(0, 360, 0, i), random.uniform(3, 85, 1, i)));
  const Eigen::Vector3d antenna(random.uniform(-10, 10, 2, 0), random.uniform(-10, 10, 3, 0), 1.5);
  const char* const kNames[] = {"specular1", "specular2", "specular3"};
  const auto model = find_model(path_models(), kNames[order - 1])->make({}, parameters);
  std::vector<SignalPaths> found(directions.size());
  GnssCounters counters;
  model->trace(antenna, directions, scene::SceneAt(boxes.scene()), found, counters);

  std::vector<Key> sequences;
  Key prefix;
  all_sequences(boxes.rectangles().size(), order, prefix, sequences);
  for (std::size_t s = 0; s < directions.size(); ++s) {
    std::map<Key, double> ours;
    for (const SignalPath& path : found[s].echoes) {
      Key key;
      for (int j = 0; j < path.reflections; ++j)
        key.push_back(boxes.rectangle_of(boxes.scene().facets().facets()[path.facets[static_cast<std::size_t>(j)]]));
      EXPECT_TRUE(ours.emplace(key, path.excess_m).second) << "a way found twice";
    }
    std::size_t possible = 0;
    for (const Key& key : sequences) {
      const auto loose = walk(boxes.rectangles(), key, antenna, directions[s], kEdge_m);
      const auto ours_at = ours.find(key);
      if (!loose) {
        EXPECT_EQ(ours_at, ours.end()) << "seed " << seed << " satellite " << s << ": a way that does not exist";
        continue;
      }
      const bool certain = walk(boxes.rectangles(), key, antenna, directions[s], -kEdge_m).has_value();
      if (certain) {
        EXPECT_NE(ours_at, ours.end()) << "seed " << seed << " satellite " << s << ": a way missed, order "
                                       << key.size();
        ++outcome.certain;
        ++outcome.per_order[key.size()];
      } else {
        ++outcome.doubtful;
      }
      if (ours_at != ours.end()) {
        ++possible;
        EXPECT_NEAR(ours_at->second, *loose, 1e-6);
      }
    }
    EXPECT_EQ(possible, ours.size());
  }
}

TEST(ImageSearch, FindsWhatBruteForceFindsAmongTiltedBoxes) {
  Outcome outcome;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) compare(RandomBoxes(seed, 6, false), 3, everything(), seed, outcome);
  EXPECT_GT(outcome.per_order[1], 80);
  EXPECT_GT(outcome.per_order[2], 20);
  EXPECT_GT(outcome.per_order[3], 10);
  EXPECT_LT(outcome.doubtful, outcome.certain / 20);
}

// With every shortcut at work: walls hide walls, low walls are left out.
TEST(ImageSearch, FindsWhatBruteForceFindsAmongUprightBoxes) {
  PathParameters p = everything();
  p.combine_all_m = 0.0;
  Outcome outcome;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) compare(RandomBoxes(seed, 7, true), 3, p, seed, outcome);
  for (std::uint64_t seed = 101; seed <= 160; ++seed) compare(RandomBoxes(seed, 20, true), 2, p, seed, outcome);
  EXPECT_GT(outcome.per_order[1], 150);
  EXPECT_GT(outcome.per_order[2], 90);
  EXPECT_GT(outcome.per_order[3], 10);
  EXPECT_LT(outcome.doubtful, outcome.certain / 20);
}

// Reach: the search with its limits finds what the search over every facet of the city finds, but for ways over two
// mirrors one of which leans and both of which are low.
TEST(ImageSearch, ReachLeavesNothingOutInTheCity) {
  scene::CityConfig config;
  config.terrain_cell_m = 10.0;
  const scene::Scene city(make_city(config));
  const scene::SceneAt at(city);
  std::vector<Eigen::Vector3d> directions;
  const RandomStream random(12, "test.satellites");
  for (std::uint64_t i = 0; i < 40; ++i)
    directions.push_back(testing::direction(random.uniform(0, 360, 0, i), random.uniform(5, 85, 1, i)));
  PathParameters limited, unlimited;
  unlimited.exhaustive = true;
  int found = 0, twice = 0, missed_twice = 0;
  for (std::size_t k = 0; k < 40; ++k) {
    const auto& edge = city.streets().edges[(k * 41) % city.streets().edges.size()];
    const Eigen::Vector2d xy = 0.6 * city.streets().nodes_W[edge.a] + 0.4 * city.streets().nodes_W[edge.b];
    const Eigen::Vector3d antenna(xy.x(), xy.y(), city.ground(xy.x(), xy.y())->height_m + 1.5);
    std::vector<SignalPaths> a(directions.size()), b(directions.size());
    GnssCounters counters;
    make_specular2(limited)->trace(antenna, directions, at, a, counters);
    make_specular2(unlimited)->trace(antenna, directions, at, b, counters);
    for (std::size_t s = 0; s < directions.size(); ++s) {
      EXPECT_LE(a[s].echoes.size(), b[s].echoes.size());
      for (const SignalPath& path : b[s].echoes) {
        const bool also = std::any_of(a[s].echoes.begin(), a[s].echoes.end(), [&](const SignalPath& p) {
          return p.facets == path.facets && p.excess_m == path.excess_m;
        });
        ++found;
        twice += path.reflections == 2 ? 1 : 0;
        if (path.reflections == 1) {
          EXPECT_TRUE(also) << "position " << k << " satellite " << s << " excess " << path.excess_m;
        } else {
          missed_twice += also ? 0 : 1;
        }
      }
    }
  }
  RecordProperty("ways", found);
  RecordProperty("missed_twice", missed_twice);
  EXPECT_GT(found, 30);
  EXPECT_GT(twice, 5);
  EXPECT_LE(missed_twice, twice / 10);
}

// Walls whose distance lies on the border of what the launched rays' sequences are keyed by: one echo for each way.
TEST(Launching, AWayIsOneEcho) {
  const auto street = WallScene()
                          .box({-60, -300, -5}, {-12.005, 300, 60}, "metal")
                          .box({9.005, -300, -5}, {60, 300, 60}, "metal")
                          .build();
  const scene::SceneAt at(*street);
  std::vector<Eigen::Vector3d> directions;
  for (int azimuth = 20; azimuth < 360; azimuth += 20)
    for (const double elevation : {30.0, 60.0}) directions.push_back(testing::direction(azimuth, elevation));
  std::vector<SignalPaths> launched(directions.size());
  GnssCounters counters;
  PathParameters p = everything();
  p.launched_rays = 50000;
  make_launching(p)->trace({0.0, 0.0, 1.5}, directions, at, launched, counters);
  int echoes = 0;
  for (const auto& paths : launched) {
    std::set<decltype(SignalPath::facets)> ways;
    for (const auto& e : paths.echoes) ways.insert(e.facets);
    EXPECT_EQ(ways.size(), paths.echoes.size());
    echoes += static_cast<int>(paths.echoes.size());
  }
  EXPECT_GT(echoes, 10);
}

// The comparison model: with more rays it finds more of the same ways, and its lengths come nearer to the exact ones.
TEST(Launching, ComesNearerToTheExactWaysWithMoreRays) {
  // A street that turns: walls at 12 m and 9 m, a third across.
  auto walls = WallScene().box({-60, -300, -5}, {-12, 300, 60}, "metal");
  walls.box({9, -300, -5}, {60, 40, 60}, "metal").box({-12, 90, -5}, {60, 100, 60}, "metal");
  const auto street = walls.build();
  const scene::SceneAt at(*street);
  const RandomStream random(9, "test.satellites");
  std::vector<Eigen::Vector3d> directions;
  for (std::uint64_t i = 0; i < 120; ++i)
    directions.push_back(testing::direction(random.uniform(0, 360, 0, i), random.uniform(5, 85, 1, i)));
  const Eigen::Vector3d antenna(0.0, 0.0, 1.5);
  PathParameters p = everything();
  GnssCounters counters;
  std::vector<SignalPaths> exact(directions.size()), launched(directions.size());
  find_model(path_models(), "specular2")->make({}, p)->trace(antenna, directions, at, exact, counters);
  double last_error_m = 1e9;
  std::size_t last_missed = 1000000, all = 0;
  for (const auto& paths : exact) all += paths.echoes.size();
  ASSERT_GT(all, 30u);
  for (const int rays : {2000, 20000, 200000}) {
    p.launched_rays = rays;
    make_launching(p)->trace(antenna, directions, at, launched, counters);
    double error_m = 0.0;
    std::size_t missed = 0, both = 0;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      for (const SignalPath& e : exact[k].echoes) {
        const auto match = std::find_if(launched[k].echoes.begin(), launched[k].echoes.end(),
                                        [&](const SignalPath& l) { return l.facets == e.facets; });
        if (match == launched[k].echoes.end()) {
          ++missed;
          continue;
        }
        ++both;
        error_m += std::abs(match->excess_m - e.excess_m);
      }
    }
    error_m /= static_cast<double>(std::max<std::size_t>(both, 1));
    RecordProperty("mean_error_mm_" + std::to_string(rays), static_cast<int>(error_m * 1e3));
    RecordProperty("missed_" + std::to_string(rays), static_cast<int>(missed));
    EXPECT_LT(error_m, last_error_m) << rays;
    EXPECT_LE(missed, last_missed) << rays;
    last_error_m = error_m;
    last_missed = missed;
  }
  // 3 / sqrt(200000) = 0.4 deg over ways of some tens of metres.
  EXPECT_LT(last_error_m, 0.5);
  EXPECT_LE(last_missed, all / 20);
}

}  // namespace
}  // namespace canyon::gnss
