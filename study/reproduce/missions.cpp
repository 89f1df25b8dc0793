// Figures 8 to 10: the mission, at the fidelities that the paper drove, and what they do to algorithms.
#include <cmath>

#include "canyon/core/process/parallel.h"
#include "canyon/study/reproduce/detection.h"
#include "canyon/study/reproduce/draws.h"
#include "canyon/study/reproduce/mission_drawings.h"
#include "canyon/study/reproduce/parts.h"
#include "canyon/study/results/over_seeds.h"
#include "canyon/study/seeds/further_seeds.h"

namespace canyon::study {
namespace {

const std::vector<std::string> kFidelities{"low", "paper", "high"};
constexpr const char* kOverSeeds =
    "Each number is the median over the seeds that have it with its 95 % interval, which fewer than six do not have; "
    "high less low is a mean difference, seed by seed, with Student's, and so not the difference of the medians.";

/// All values of a figure of one run over the seeds.
std::vector<double> values_of(const Results& results, std::size_t run, const char* key) {
  const Figure* figure = find_figure(key);
  std::vector<double> out;
  for (const auto& seed : runs_by_seed(results)) out.push_back(estimate(*figure, seed[run]).value);
  return out;
}

PaperRow figure_row(const Results& results, const char* what, const char* unit, const char* key) {
  std::vector<OverSeedsOf> forms;
  for (std::size_t run = 0; run < kFidelities.size(); ++run)
    forms.push_back({kFidelities[run], values_of(results, run, key)});
  return over_seeds_row(what, unit, std::move(forms));
}

Result<Results> driven(const Comparison& comparison, std::int64_t seeds, const std::string& scratch, bool progress) {
  CANYON_TRY(Results results, compare(comparison, "", progress));
  if (seeds > 1) CANYON_TRY_STATUS(add_further_seeds(comparison, seeds - 1, scratch, progress, results));
  return results;
}

PaperRow success_row(const Results& closed) {
  PaperRow row{.what = "share of missions that succeed", .unit = "", .ours = {}};
  const OverSeeds over = over_seeds(runs_by_seed(closed));
  for (const Share& share : over.shares)
    row.ours.push_back({share.fidelity, static_cast<double>(share.success) / share.n, share.interval, share.n});
  for (const PairedDifference& pair : over.paired)
    if (pair.figure == "success" && pair.b == kFidelities.back())
      row.ours.push_back({pair.b + " less " + pair.a, pair.difference, pair.interval, pair.n});
  return row;
}

/// What fidelities do to detection and planning, by seeds from the mission's own on.
Result<std::vector<PaperRow>> seen_and_planned_rows(const Comparison& open, std::int64_t seeds) {
  struct Column {
    const char *what, *unit;
    double SeenAndPlanned::*value;
  };
  constexpr Column kColumns[] = {
      {"obstacle detection: directions with a phantom", "", &SeenAndPlanned::phantom_share},
      {"obstacle detection: things missed, of those that stand there", "", &SeenAndPlanned::missed_share},
      {"obstacle detection: range to the first thing, RMS error", "m", &SeenAndPlanned::range_rms_m},
      {"planning: steering asked for, RMS off that with the true pose", "deg", &SeenAndPlanned::steering_rms_deg},
      {"planning: speed asked for, RMS off that with the true pose", "m/s", &SeenAndPlanned::speed_rms_m_s}};
  const std::size_t runs = kFidelities.size(), n = static_cast<std::size_t>(seeds);
  std::vector<std::optional<Result<SeenAndPlanned>>> found(runs * n);
  parallel_for(runs * n, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mission::MissionConfig config = open.configs[i / n];
      config.run.seed += static_cast<std::int64_t>(i % n);
      found[i] = seen_and_planned(config, open.missions[i / n], *open.tape);
    }
  });
  for (const auto& one : found)
    if (!*one) return one->error();
  std::vector<PaperRow> rows;
  for (const Column& column : kColumns) {
    std::vector<OverSeedsOf> forms;
    for (std::size_t run = 0; run < runs; ++run) {
      forms.push_back({kFidelities[run], {}});
      for (std::size_t k = 0; k < n; ++k) forms.back().values.push_back((**found[run * n + k]).*column.value);
    }
    rows.push_back(over_seeds_row(column.what, column.unit, std::move(forms)));
  }
  return rows;
}

}  // namespace

Result<std::vector<PaperPart>> mission_parts(const mission::MissionFile& file, std::int64_t seeds,
                                             const std::string& scratch, bool show_progress) {
  CANYON_TRY(Comparison closed, prepare_comparison(file, plan_runs(kFidelities, false)));
  CANYON_TRY_STATUS(check_seeds(closed, seeds));
  Comparison open = closed;
  CANYON_TRY_STATUS(choose_tape({}, open));
  CANYON_TRY(const Results driven_closed, driven(closed, seeds, scratch, show_progress));
  CANYON_TRY(const Results driven_open, driven(open, seeds, scratch, show_progress));

  PaperPart mission{
      .name = "figures_8_to_10",
      .title = "Fig. 8 to 10: the reconnaissance mission with simple and with high-fidelity models",
      .paper_says =
          "With simple models (fixes 30 to 50 cm off, a perfect IMU) the mission succeeded and truth and "
          "output cannot be told apart; with the paper's models it never did, and the position varied most "
          "in height.",
      .made =
          "The built-in mission: a city of the paper's size at its place. Shares of missions each of which drives "
          "by itself; all else on the mission's own route, driven on truth, the same for all, over seeds. Drawn: the "
          "first seed on that route; fixes are the antenna's, which is mounted above the vehicle's own point.",
      .difference =
          {"The paper's scene, route and autonomy are not published.",
           "Why missions fail is another question than how often: docs/ablations.md names what has been shown with a "
           "control.",
           kOverSeeds},
      .x_label = "Time, s",
      .rows = {success_row(driven_closed), figure_row(driven_open, "error of the fixes, RMS", "m", "fix_error_rms_m"),
               figure_row(driven_open, "east error of the output, RMS", "m", "position_error_e_rms_m"),
               figure_row(driven_open, "north error of the output, RMS", "m", "position_error_n_rms_m"),
               figure_row(driven_open, "height error of the output, RMS", "m", "position_error_up_rms_m")},
      .curves = scene_curves(open.configs.front(), open.missions.front())};
  CANYON_TRY(auto tracks, track_curves(open));
  for (PaperCurve& curve : tracks) mission.curves.push_back(std::move(curve));
  CANYON_TRY(auto seen_rows, seen_and_planned_rows(open, seeds));

  PaperPart algorithms{
      .name = "algorithms",
      .title = "Named as future work: what the models do to the output of algorithms",
      .paper_says = "Work is underway to test the models by their impact on the output of specific algorithms.",
      .made =
          "On the same route, open loop, over seeds: localization, registration of scans, the map made of them, what "
          "blocks the way in a grid that lies where the pose puts it, and what the autonomy asks for, against the same "
          "scans with the true pose.",
      .difference = {kOverSeeds},
      .x_label = "",
      .rows = {figure_row(driven_open, "localization: position error, RMS", "m", "position_error_rms_m"),
               figure_row(driven_open, "localization: yaw error, RMS", "deg", "attitude_error_yaw_rms_deg"),
               figure_row(driven_open, "registration: error before it, RMS", "m", "registration_error_prior_rms_m"),
               figure_row(driven_open, "registration: error after it, RMS", "m", "registration_error_rms_m"),
               figure_row(driven_open, "map: error, RMS", "m", "map_error_rms_m")},
      .curves = {}};
  for (PaperRow& row : seen_rows) algorithms.rows.push_back(std::move(row));
  return std::vector<PaperPart>{std::move(mission), std::move(algorithms)};
}

}  // namespace canyon::study
