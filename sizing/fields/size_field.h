// How large elements should be, as a function of place.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace HEXTWIST_API hextwist {

/// A wished size at every point of space. Guarantees of every implementation: immutable, any number of threads may ask;
/// sizes are positive, infinity where there is no wish. Throws Error where a size is not (an expression that is
/// negative or not a number there), naming the place.
class SizeField {
 public:
  virtual ~SizeField() = default;
  /// out: one size per point, in model units.
  virtual void evaluate(std::span<const Vec3> points, std::span<double> out) const = 0;
  /// No size is smaller anywhere; 0 when that is not known. Elements below it need not be asked about.
  virtual double least() const { return 0; }
  /// No size is smaller at this point, said without looking closely; least() when that is not known.
  virtual double least_at(const Vec3& /*point*/) const { return least(); }
  /// Changes abruptly, from hex to hex: what it says at a node means nothing.
  virtual bool jumps() const { return false; }
  /// The size at one point: evaluate() for that alone.
  double at(const Vec3& p) const;
};
/// Fields are shared by whoever asks them; none is a null pointer.
using SizeFieldPtr = std::shared_ptr<const SizeField>;

/// The same everywhere. Throws Error unless it is positive and finite.
SizeFieldPtr constant_size(double size);

/// What is wrong with the text of an expression, and where.
struct SizeExpressionError : Error {
  /// what: one line; at: the position.
  SizeExpressionError(const std::string& what, std::size_t at) : Error(what), position(at) {}
  std::size_t position;  ///< of the character in the expression, 0-based; its length: the end
};
/// The value of a muParser expression in x, y and z: "0.1 + 0.2*abs(x)"; pi is known. Infinity is no wish.
/// Throws SizeExpressionError when the text is none; evaluating throws Error where it is not a positive number.
SizeFieldPtr expression_size(const std::string& expression);

/// A field of a mesh, which is kept: nodal values are interpolated trilinearly, those of a hex hold throughout it.
/// Outside of the mesh the nearest place counts. Throws Error when there is no such field, when it has several
/// components, and naming the first node or hex at which it is not positive.
SizeFieldPtr field_size(std::shared_ptr<const Mesh> mesh, const std::string& field);

/// So many elements per radian at curved entities (curves and surfaces): the radius of curvature divided by that
/// number, growing from there by growth - 1 per unit of distance. No wish where nothing is curved. Of the skin of a
/// mesh the curvature is estimated (geom/facet/curvature_internal.h). Throws Error for a model that knows no curvature
/// and when none of the entities is curved.
SizeFieldPtr curvature_size(std::shared_ptr<const Model> model, std::span<const Owner> entities,
                            double elements_per_radian, double growth);

/// So many elements along each of these curves, growing from there.
SizeFieldPtr interval_size(const MeshedModel& input, std::span<const Index> curves, int n_intervals, double growth);

/// The wish of a field at the nodes and centroids of a mesh, lowered until it grows by no more than growth - 1 per unit
/// of distance along the edges, and interpolated. The smaller of that and the field itself is a field that grows so
/// slowly.
SizeFieldPtr limited_growth(const Mesh& mesh, const SizeFieldPtr& field, double growth);

/// The smallest of several. Throws Error when there are none.
SizeFieldPtr smallest_of(std::vector<SizeFieldPtr> fields);

}  // namespace hextwist
