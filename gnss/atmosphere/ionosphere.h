#pragma once

#include <memory>
#include <span>

#include "canyon/core/model_choice.h"
#include "canyon/core/need.h"
#include "canyon/gnss/atmosphere/klobuchar.h"
#include "canyon/gnss/sky_view.h"

namespace canyon::gnss {

/// Group delay of the ionosphere at L1 along the line of sight.
class IonosphereModel {
 public:
  virtual ~IonosphereModel() = default;
  /// m, >= 0, for elevations in [0, pi/2].
  virtual double delay_m(const SkyView& view) const = 0;
  /// False if there is none: then nothing is corrected, and none is left.
  virtual bool acts() const { return true; }
};

/// Key of the models that scale a mapping by it.
struct ElectronContent {
  double vtec_tecu = 12.0;  ///< vertical total electron content, 1 TECU = 1e16 electrons/m^2
};
void visit(FieldVisitor& f, ElectronContent& c);

/// What models are built from beside their own keys.
struct IonosphereSetup {
  KlobucharCoefficients klobuchar;  ///< of the navigation file
  GpsTime start{}, end{};           ///< that a model must know
  std::vector<std::string>* warnings = nullptr;
};

/// The largest delay that a model gives anywhere at or above a view's elevation.
using LargestIonosphere = double(const IonosphereModel& model, const SkyView& lowest);
/// Of a model whose delay falls with elevation, and depends on nothing else.
LargestIonosphere largest_at_lowest;

using MakeIonosphere =
    MakerAndNeed<Result<std::unique_ptr<IonosphereModel>>(const ModelParameters& own, const IonosphereSetup& at),
                 LargestIonosphere>;
ModelTable<MakeIonosphere> ionosphere_models();

std::unique_ptr<IonosphereModel> make_single_layer(double vtec_tecu);
Result<std::unique_ptr<IonosphereModel>> make_klobuchar(const ModelParameters& own, const IonosphereSetup& at);
Result<std::unique_ptr<IonosphereModel>> make_ionex(const ModelParameters& own, const IonosphereSetup& at);
void ionex_parameters(ModelParameters& section);
Result<std::unique_ptr<IonosphereModel>> make_paper_ionosphere(const ModelParameters& own, const IonosphereSetup& at);
Result<std::unique_ptr<IonosphereModel>> make_paper_printed_ionosphere(const ModelParameters& own,
                                                                       const IonosphereSetup& at);

/// Vertical delay at L1, m: 40.3 m^3/s^2 x electrons / f^2.
double vertical_ionosphere_m(double vtec_tecu);
/// Obliquity of a thin shell at 350 km over a sphere of 6378.137 km: 1 / sqrt(1 - (R cos e / (R + h))^2).
double single_layer_obliquity(double elevation_rad);
/// Lear's mapping as Montenbruck & Garcia-Fernandez (2005) give it: 2.037 / (sqrt(sin^2 e + 0.076) + sin e).
double lear_mapping(double elevation_rad);

}  // namespace canyon::gnss
