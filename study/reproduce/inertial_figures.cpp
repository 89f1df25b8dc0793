// Figures 2, 3 and 7: resting units and where plain integration takes them.
#include <cmath>

#include "canyon/inertial/paper_figures.h"
#include "canyon/study/reproduce/draws.h"
#include "canyon/study/reproduce/parts.h"

namespace canyon::study {
namespace {

using inertial::PaperDrift;
using inertial::PaperFigure;

struct ChainForm {
  const char* chain;
  const char* words;
};
constexpr ChainForm kForms[] = {{"paper_as_printed", "as printed"}, {"paper", "as corrected"}};
constexpr std::size_t kEvery = 125;  // samples a second; the drawings show one

/// What a figure of the paper is, in numbers.
struct FigureWords {
  const char* name;  ///< of inertial::paper_figures()
  const char* title;
  const char* says;
  const char* what;
  const char* unit;
  double paper, per_unit_s;  ///< a drift of `paper` degrees in per_unit_s
  std::vector<std::string> difference;
};

const std::vector<FigureWords>& figure_words() {
  static const std::vector<FigureWords> kWords{
      {"figures_2_and_3",
       "Fig. 2 and 3: rates and heading of a high-grade unit at rest, 20 minutes",
       "The total drift of the three gyroscopes is about 3 deg/h.",
       "drift of a gyroscope",
       "deg/h",
       3.0,
       3600.0,
       {"As printed a thermal noise in metres and the quantization's quality factor are added to the rate, and the "
        "bias "
        "recursion forgets within milliseconds: what is left is a mean of both."}},
      {"figure_7",
       "Fig. 7: a hobby unit at rest, ten minutes, with the parameters beside the figure",
       "Drift of about 3 deg/min of the real unit, kilometres after two hours; real and simulated match remarkably "
       "well.",
       "drift of a gyroscope",
       "deg/min",
       3.0,
       60.0,
       {"The null offsets were those of the authors' own unit and are not printed: ours come from the catalogue, so "
        "only the size can agree."}},
      {"figure_7_text_parameters",
       "Fig. 7 again, with the parameters of the text before it",
       "The text prints another set: quality factor 0.15, 0.30 deg/s and 0.15 m/s2.",
       "drift of a gyroscope",
       "deg/min",
       3.0,
       60.0,
       {"Which of the two sets the figure was made with is not said."}}};
  return kWords;
}

/// One value a second, of each axis.
void add_curves(const PaperDrift& drift, const char* form, std::vector<PaperCurve>& out) {
  const auto add = [&](const char* panel, const char* unit, const std::array<std::vector<double>, 3>& of) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      PaperCurve curve{.panel = std::string(panel) + ", " + form,
                       .unit = unit,
                       .name = std::string(1, "xyz"[axis]),
                       .x = {},
                       .y = {},
                       .points = false};
      for (std::size_t k = kEvery - 1; k < drift.t_s.size(); k += kEvery) {
        curve.x.push_back(drift.t_s[k]);
        curve.y.push_back(of[axis][k]);
      }
      out.push_back(std::move(curve));
    }
  };
  add("Angular rate", "deg/s", drift.rate_deg_s);
  add("Heading of each gyroscope", "deg", drift.angle_deg);
  add("Position", "m", drift.position_m);
}

Result<PaperPart> part_of(const PaperFigure& figure, const FigureWords& words, std::int64_t draws) {
  PaperPart part{.name = words.name,
                 .title = words.title,
                 .paper_says = words.says,
                 .made = std::string(figure.doc) +
                         "; no gravity, no Earth rate, plain integration at 125 Hz; the "
                         "drawings show the first seed",
                 .difference = words.difference,
                 .x_label = "Time, s",
                 .rows = {},
                 .curves = {}};
  PaperRow drift_row{.what = words.what, .unit = words.unit, .paper = words.paper, .ours = {}};
  PaperRow place_row{.what = "distance at the end", .unit = "m", .ours = {}};
  for (const ChainForm& form : kForms) {
    std::vector<double> rates, places_m;
    for (std::int64_t seed = 1; seed <= draws; ++seed) {
      CANYON_TRY(const PaperDrift drift, inertial::paper_drift(figure, form.chain, static_cast<std::uint64_t>(seed)));
      double square_m2 = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        rates.push_back(std::abs(drift.angle_deg[axis].back()) / figure.seconds * words.per_unit_s);
        square_m2 += drift.position_m[axis].back() * drift.position_m[axis].back();
      }
      places_m.push_back(std::sqrt(square_m2));
      if (seed == 1) add_curves(drift, form.words, part.curves);
    }
    drift_row.ours.push_back(over_draws(form.words, rates));
    place_row.ours.push_back(over_draws(form.words, places_m));
  }
  part.rows = {drift_row, place_row};
  return part;
}

}  // namespace

Result<std::vector<PaperPart>> inertial_parts(std::int64_t draws) {
  std::vector<PaperPart> parts;
  for (const FigureWords& words : figure_words())
    for (const PaperFigure& figure : inertial::paper_figures())
      if (words.name == std::string_view(figure.name)) {
        CANYON_TRY(PaperPart part, part_of(figure, words, draws));
        parts.push_back(std::move(part));
      }
  return parts;
}

}  // namespace canyon::study
