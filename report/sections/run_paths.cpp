#include "canyon/report/sections/run_paths.h"

#include <algorithm>
#include <cmath>

#include "canyon/report/draw/theme.h"
#include "canyon/report/format.h"
#include "canyon/report/maps/polyline.h"
#include "canyon/report/read/run_story.h"

namespace canyon::report {
namespace {

/// The pieces of a path that are defined and near the window.
std::vector<std::vector<Eigen::Vector2d>> pieces(const std::vector<double>& x, const std::vector<double>& y,
                                                 const MapWindow* window) {
  std::vector<std::vector<Eigen::Vector2d>> out;
  bool open = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector2d p(x[i], y[i]);
    bool keep = p.allFinite();
    if (keep && window) {
      // One window's size of margin: lines that leave it go on to its edge.
      const Eigen::Vector2d margin_m = window->size_m();
      keep = ((p - (window->min_W - margin_m)).array() > 0).all() && ((window->max_W + margin_m - p).array() > 0).all();
    }
    if (!keep) {
      open = false;
      continue;
    }
    if (!open) out.emplace_back();
    open = true;
    out.back().push_back(p);
  }
  return out;
}

std::string path_of(const MapDrawing& map, const std::vector<double>& x, const std::vector<double>& y,
                    const MapWindow* window, double tolerance_m) {
  std::string out;
  for (const auto& piece : pieces(x, y, window)) {
    std::vector<Eigen::Vector2d> kept;
    for (const std::size_t i : simplify_polyline(piece, tolerance_m)) kept.push_back(piece[i]);
    out += map.path(kept, 2);
  }
  return out;
}

}  // namespace

std::string draw_ribbon(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow* window,
                        double tolerance_m, double width_px) {
  if (!run.nav) return {};
  return "<path class=\"ribbon " + run_class(run_number) + "\" style=\"stroke-width:" + fixed(width_px, 1) +
         "px\" d=\"" + path_of(map, (*run.nav)["true_x_m"], (*run.nav)["true_y_m"], window, tolerance_m) + "\"/>\n";
}

std::string draw_estimate(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow* window,
                          double tolerance_m) {
  if (!run.nav) return {};
  return "<path class=\"line estimate " + run_class(run_number) + "\" d=\"" +
         path_of(map, (*run.nav)["est_x_m"], (*run.nav)["est_y_m"], window, tolerance_m) + "\"/>\n";
}

std::string draw_error_ties(const MapDrawing& map, const Run& run, std::size_t run_number, const MapWindow& window,
                            double every_s) {
  if (!run.nav || run.nav->rows == 0) return {};
  const EpochTable& nav = *run.nav;
  std::string ties;
  double next_s = nav["t_s"].front();
  // While the vehicle stands, the ties of a still estimate would only blacken one place.
  const double least_move_m = 0.01 * window.size_m().x();
  Eigen::Vector2d last_truth(INFINITY, INFINITY), last_estimate(INFINITY, INFINITY);
  for (std::size_t i = 0; i < nav.rows; ++i) {
    if (nav["t_s"][i] < next_s) continue;
    next_s = nav["t_s"][i] + every_s - 1e-6;
    const Eigen::Vector2d truth(nav["true_x_m"][i], nav["true_y_m"][i]), estimate(nav["est_x_m"][i], nav["est_y_m"][i]);
    if (!truth.allFinite() || !estimate.allFinite()) continue;
    if ((truth - last_truth).norm() < least_move_m && (estimate - last_estimate).norm() < least_move_m) continue;
    last_truth = truth, last_estimate = estimate;
    const bool inside = ((truth - window.min_W).array() > 0).all() && ((window.max_W - truth).array() > 0).all();
    if (inside) ties += "M" + map.point(truth, 2) + " " + map.point(estimate, 2);
  }
  return "<path class=\"tie " + run_class(run_number) + "\" d=\"" + ties + "\"/>\n";
}

std::string draw_track(const MapDrawing& map, const Run& run, std::size_t run_number) {
  if (!run.nav || run.nav->rows < 2) return {};
  const EpochTable& nav = *run.nav;
  const double first_s = nav["t_s"].front(), last_s = nav["t_s"].back();
  const double step_s = std::max(1.0, std::ceil((last_s - first_s) / 600));
  std::string truth, estimate;
  for (double t_s = first_s; t_s <= last_s; t_s += step_s) {
    const std::size_t i = *row_at(nav, t_s);
    const Eigen::Vector2d p(nav["true_x_m"][i], nav["true_y_m"][i]), q(nav["est_x_m"][i], nav["est_y_m"][i]);
    truth += (truth.empty() ? "" : " ") + (p.allFinite() ? map.point(p) : "- -");
    estimate += (estimate.empty() ? "" : " ") + (q.allFinite() ? map.point(q) : "- -");
  }
  return "<g class=\"track " + run_class(run_number) + "\" data-start=\"" + fixed(first_s, 3) + "\" data-step=\"" +
         fixed(step_s, 0) + "\" data-truth=\"" + truth + "\" data-estimate=\"" + estimate + "\"></g>\n";
}

}  // namespace canyon::report
