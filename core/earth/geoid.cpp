#include "canyon/core/earth/geoid.h"

#include <GeographicLib/Geoid.hpp>

#include <exception>
#include <optional>

#include "canyon/core/check.h"
#include "canyon/core/earth/geoid_grid.h"
#include "canyon/core/process/embedded.h"
#include "canyon/core/units.h"

namespace canyon {
namespace {

constexpr const char* kBuiltIn = "egm96-30";

GeoidGrid built_in_grid() {
  const auto file = embedded_file("core/earth/geoid/egm96-30.pgm");
  CANYON_CHECK(file.has_value(), "no built-in geoid");
  return GeoidGrid(*file);
}

}  // namespace

/// One of the two.
class Geoid::Model {
 public:
  explicit Model(const char* installed) : name_(installed), installed_(std::in_place, installed) {}
  Model() : name_(kBuiltIn), grid_(built_in_grid()) {}

  double undulation_m(const Geodetic& g) const {
    return grid_ ? grid_->undulation_m(g) : (*installed_)(g.lat_rad / kDegree, g.lon_rad / kDegree);
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::optional<GeographicLib::Geoid> installed_;
  std::optional<GeoidGrid> grid_;
};

Geoid::Geoid() {
  for (const char* model : {"egm2008-1", "egm2008-2_5", "egm2008-5", "egm96-5", "egm96-15", "egm84-15", "egm84-30"}) {
    try {
      model_ = std::make_unique<Model>(model);
      return;
    } catch (const std::exception&) {
      // not installed: the next one
    }
  }
  model_ = std::make_unique<Model>();
}

Geoid::Geoid(std::unique_ptr<Model> model) : model_(std::move(model)) {}
Geoid::Geoid(Geoid&&) noexcept = default;
Geoid::~Geoid() = default;

Geoid Geoid::built_in() {
  return Geoid(std::make_unique<Model>());
}

double Geoid::undulation_m(const Geodetic& g) const {
  return model_->undulation_m(g);
}
const std::string& Geoid::model() const {
  return model_->name();
}

GeoidHeight geoid_height(const Geodetic& g) {
  const Geoid geoid;
  return {geoid.undulation_m(g), geoid.model()};
}

}  // namespace canyon
