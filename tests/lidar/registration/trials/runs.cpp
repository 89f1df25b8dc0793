#include "canyon/tests/lidar/registration/trials/runs.h"

#include "canyon/core/process/parallel.h"
#include "canyon/lidar/registration/engine/engine_registration.h"
#include "canyon/lidar/registration/prepared_cloud.h"

namespace canyon::lidar::trials {
namespace {

std::unique_ptr<Registration> method_of(const std::string& name, const std::string& form, double leaf_m) {
  RegistrationConfig config;
  config.method.name = name;
  config.method.own.get<MatchingParameters>().leaf_m = leaf_m;
  config.method.own.get<EngineParameters>().covariance = form;
  return *make_registration(config);
}

Outcome run_one(const Trial& trial, std::span<const std::unique_ptr<Registration>> forms, const Registration* pcl) {
  Outcome out;
  out.ambiguous = trial.ambiguous;
  out.open_in_truth = static_cast<int>(trial.open.size());
  const auto source = forms[0]->prepare(trial.source);
  const Registration::Placed target{forms[0]->prepare(trial.target), Pose{}};
  const double radius_m = rms_radius(source->points);
  out.points = source->points.size();
  for (const auto& form : forms) {
    const auto result = form->align_with_prior(*source, {&target, 1}, trial.prior);
    out.forms.push_back(judge(trial, result, radius_m));
    if (out.forms.size() > 1) continue;
    out.status = result.status;
    out.overlap = result.overlap;
    out.all_right = right_where_determined(trial, result.X_TS, radius_m);
  }
  out.verdict = out.forms[0];
  if (pcl == nullptr) return out;
  const auto theirs = pcl->prepare(trial.source);
  const Registration::Placed their_target{pcl->prepare(trial.target), Pose{}};
  const auto result = pcl->align(*theirs, {&their_target, 1}, trial.prior.X_TS);
  out.pcl_converged = result.status == RegistrationStatus::kConverged;
  out.pcl_right = right_where_determined(trial, result.X_TS, radius_m);
  return out;
}

}  // namespace

std::vector<Outcome> run_trials(const Asked& asked, const Place& place, const Sensor& sensor, const Ring& ring,
                                std::uint64_t seed, std::uint64_t count) {
  std::vector<std::unique_ptr<Registration>> forms;
  for (const std::string& form : asked.forms) forms.push_back(method_of(asked.method, form, asked.leaf_m));
  const bool has_pcl = model_row(registration_methods(), "pcl_gicp").make.make != nullptr;
  const auto pcl = asked.pcl && has_pcl ? method_of("pcl_gicp", "sandwich", asked.leaf_m) : nullptr;
  std::vector<Outcome> out(count);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      out[k] = run_one(make_trial(place, sensor, ring, seed, k), forms, pcl.get());
  });
  return out;
}

}  // namespace canyon::lidar::trials
