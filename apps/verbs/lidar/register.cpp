#include <algorithm>
#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/usage_errors.h"
#include "canyon/apps/line/verb.h"
#include "canyon/apps/options/gnss_setup.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/lidar/registration/cloud_pair.h"

namespace canyon::apps {

namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> guess;
  std::string source, target, method = "gicp", sigma, covariance = "calibrated", kernel = "geman_mcclure";
  double leaf_m = 0.25, reach_m = 1.0;
  std::int64_t iterations = 50;
};

/// [registration] as the options have it: the section is read as a mission file's is, so that its own messages come.
Result<lidar::RegistrationConfig> registration_config(const Options& o) {
  const auto text = "method = \"" + o.method + "\"\ncovariance = \"" + o.covariance + "\"\nkernel = \"" + o.kernel +
                    "\"\nleaf_m = " + std::to_string(o.leaf_m) +
                    "\nmax_correspondence_m = " + std::to_string(o.reach_m) +
                    "\nmax_iterations = " + std::to_string(o.iterations) + "\n";
  CANYON_TRY(const auto node, ConfigNode::parse(text, "options"));
  lidar::RegistrationConfig config;
  const Status read = read_config(&node, "registration", config);
  if (read) return config;
  Error error = read.error();
  for (const char* name : {"method", "covariance", "kernel"}) {
    if (error.key != std::string("registration.") + name) continue;
    error.file = std::string("--") + name;
    error.line = 0;
    error.key.clear();
  }
  return error;
}

Result<lidar::PosePrior> prior_of(const Options& o) {
  lidar::PosePrior prior;
  if (!o.guess.empty()) {
    std::string all;  // apart by commas, by blanks, or as words of their own
    for (const std::string& part : o.guess) all += (all.empty() ? "" : ",") + part;
    std::replace(all.begin(), all.end(), ' ', ',');
    CANYON_TRY(const auto v, parse_numbers(all, 16, "--guess", "16 numbers, row by row: T_target_source"));
    Eigen::Matrix4d T;
    for (int i = 0; i < 16; ++i) T(i / 4, i % 4) = v[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    if (!T.allFinite() || (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3 ||
        R.determinant() < 0 || (T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-9)
      return Error{"--guess", 0, "", "is no rigid transform", "a rotation to 1e-3, a shift, and 0 0 0 1"};
    prior.X_TS = Pose::from_matrix(T);
  }
  if (!o.sigma.empty()) {
    CANYON_TRY(const auto v, parse_numbers(o.sigma, 2, "--sigma", "METRES,DEGREES: of the guess, per axis"));
    if (!(v[0] >= 0 && v[1] >= 0 && v[0] < 1e4 && v[1] <= 180))
      return Error{"--sigma", 0, "", '"' + o.sigma + '"', "0 to 1e4 m and 0 to 180 degrees"};
    prior.covariance.setZero();
    prior.covariance.diagonal() << Eigen::Vector3d::Constant(v[1] * v[1] * kDegree * kDegree),
        Eigen::Vector3d::Constant(v[0] * v[0]);
  }
  return prior;
}

Json rows(const Eigen::MatrixXd& m) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j) out.push_back(or_null(m(i, j)));
  return out;
}

/// Where an alignment came to nothing the result holds the guess, which is no pose of the surfaces; others may have one
/// and no covariance.
bool has_pose(const lidar::RegistrationResult& r) {
  using enum lidar::RegistrationStatus;
  const bool nothing =
      r.status == kTooFewPoints || r.status == kDegenerate || r.status == kDiverged || r.status == kTooLittleOverlap;
  return !nothing || r.covariance.allFinite();
}

Json answer(const Options& options, const lidar::CloudPair& pair) {
  const lidar::RegistrationResult& r = pair.result;
  Json open = Json::array();
  for (const Vector6d& v : r.open) open.push_back(rows(v.transpose()));
  return {
      {"T_target_source", has_pose(r) ? rows(r.X_TS.matrix()) : Json()},
      {"status", row_of(lidar::registration_statuses(), r.status).name},
      {"covariance", rows(r.covariance)},
      {"open_directions", open},
      {"overlap", or_null(r.overlap)},
      {"rms_m", or_null(r.rms_m)},
      {"iterations", r.iterations},
      {"method", options.method},
      {"points", {{"source", pair.source_points}, {"target", pair.target_points}}},
      {"time_ms",
       {{"total", pair.preprocess_ms + pair.align_ms}, {"preprocess", pair.preprocess_ms}, {"align", pair.align_ms}}}};
}

void print(const lidar::CloudPair& pair) {
  const lidar::RegistrationResult& r = pair.result;
  std::printf("%s after %d rounds, %zu points onto %zu, %.1f ms (%.1f to prepare, %.1f to align)\n",
              row_of(lidar::registration_statuses(), r.status).name, r.iterations, pair.source_points,
              pair.target_points, pair.preprocess_ms + pair.align_ms, pair.preprocess_ms, pair.align_ms);
  if (!has_pose(r)) {
    std::printf("no pose\n");
    return;
  }
  const Eigen::Matrix4d T = r.X_TS.matrix();
  for (int i = 0; i < 4; ++i) std::printf("%15.9f %15.9f %15.9f %15.6f\n", T(i, 0), T(i, 1), T(i, 2), T(i, 3));
  if (!r.covariance.allFinite()) return;
  const Vector6d sigma = r.covariance.diagonal().cwiseSqrt();
  std::printf("sigma: rotation %.4f %.4f %.4f deg, position %.4f %.4f %.4f m (source frame); %zu open directions\n",
              sigma[0] / kDegree, sigma[1] / kDegree, sigma[2] / kDegree, sigma[3], sigma[4], sigma[5], r.open.size());
}

Result<int> run(const Options& options) {
  set_threads(options.common.threads);
  CANYON_TRY(const lidar::RegistrationConfig config, registration_config(options));
  CANYON_TRY(const auto method, lidar::make_registration(config));
  CANYON_TRY(const lidar::PosePrior prior, prior_of(options));
  CANYON_TRY(const CloudPlaces source, lidar::read_cloud(options.source));
  CANYON_TRY(const CloudPlaces target, lidar::read_cloud(options.target));
  for (const std::string& doubt :
       {lidar::cloud_doubt(options.source, source), lidar::cloud_doubt(options.target, target)})
    if (!doubt.empty()) print_warning(doubt);
  const lidar::CloudPair pair = lidar::register_pair(*method, source, target, prior);
  if (options.common.json)
    std::printf("%s\n", json_text(answer(options, pair)).c_str());
  else
    print(pair);
  return 0;
}

VerbAction declare(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments
      .option("source", options->source, "cloud that is moved: PCD, PLY, LAS, .bin, or a Velodyne or Ouster capture")
      .type("SOURCE")
      .required();
  arguments.option("target", options->target, "cloud that stays, likewise").type("TARGET").required();
  arguments.option("--method", options->method, "row of [registration] method (docs/registration.md)").default_shown();
  arguments
      .option("--leaf", options->leaf_m,
              "voxel size to which both clouds are thinned, metres; clouds of 16 beams want 0.5")
      .default_shown()
      .within(0.01, 100.0);
  arguments.option("--reach", options->reach_m, "points farther apart are not matched in the end, metres")
      .default_shown()
      .within(0.01, 100.0);
  arguments
      .option(
          "--iterations", options->iterations,
          "most rounds of matching in one descent on all points; reported are the rounds of all starts and descents, "
          "coarse ones too")
      .default_shown()
      .within(std::int64_t{1}, std::int64_t{1000});
  arguments.option("--guess", options->guess, "T_target_source to start from: 16 numbers, row by row");
  arguments.option(
      "--sigma", options->sigma,
      "METRES,DEGREES: how sure the guess is, its turn about the middle of SOURCE; with it the search goes as far");
  arguments.option("--covariance", options->covariance, "row of [registration] covariance").default_shown();
  arguments.option("--kernel", options->kernel, "row of [registration] kernel").default_shown();
  return [options]() -> Result<int> { return run(*options); };
}

}  // namespace

Verb lidar_register_verb() {
  return {"lidar register", "one cloud onto another: the pose, its covariance and a status",
          "canyon lidar register source.ply target.ply --method gicp --leaf 0.25 --json", declare};
}

}  // namespace canyon::apps
