#pragma once

#include <cstdint>
#include <vector>

#include "canyon/gnss/paths/beam.h"
#include "canyon/scene/surfaces/facet.h"

namespace canyon::gnss {

/// The facets that take part in a search, as arrays of single precision in spatial order, 16 in a row with a ball
/// around them: most beams miss most rows.
class FacetRows {
 public:
  std::vector<std::uint32_t> ids;  ///< indices into Scene::facets(); fill() once they are chosen

  void fill(const std::vector<scene::Facet>& facets);
  /// Those that may be met through `window` from the beam's apex, the image of the antenna behind it, and that face the
  /// apex: their indices, in the order of `ids`. Replaces what is in `out`. A centimetre of slack for single precision;
  /// what is given in vain fails later.
  void meet(const scene::Facet& window, const Beam& beam, std::vector<std::uint32_t>& out) const;

 private:
  std::size_t rows_ = 0;  ///< filled up with rows and facets that lie within no beam
  std::vector<float> x_, y_, z_, radius_, nx_, ny_, nz_, offset_;
  std::vector<double> row_x_, row_y_, row_z_, row_radius_;
};

}  // namespace canyon::gnss
