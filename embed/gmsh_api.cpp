#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "hextwist/embed/gmsh.h"

namespace hextwist {
namespace {

namespace model = gmsh::model;
namespace mesh = gmsh::model::mesh;

/// Calls f; what Gmsh throws (texts, in some versions numbers) becomes an Error.
template <class F>
auto asking(const char* what, F f) {
  const std::string prefix = std::string("Gmsh: ") + what + ": ";
  try {
    return f();
  } catch (const std::exception& error) {
    throw Error(prefix + error.what());
  } catch (const std::string& text) {
    throw Error(prefix + text);
  } catch (...) {
    throw Error(prefix + "failed");
  }
}

GmshEntity read_entity(int dim, int tag) {
  GmshEntity entity;
  entity.dim = dim;
  entity.tag = tag;
  mesh::getNodes(entity.node_tags, entity.coord, entity.parametric, dim, tag, false, true);
  mesh::getElements(entity.element_types, entity.element_tags, entity.element_nodes, dim, tag);
  return entity;
}

GmshModel read_model() {
  GmshModel result;
  gmsh::vectorpair entities, groups;
  model::getEntities(entities);
  for (const auto& [dim, tag] : entities) result.entities.push_back(read_entity(dim, tag));
  model::getPhysicalGroups(groups);
  for (const auto& [dim, tag] : groups) {
    GmshGroup group{dim, tag, "", {}};
    model::getPhysicalName(dim, tag, group.name);
    model::getEntitiesForPhysicalGroup(dim, tag, group.entities);
    result.groups.push_back(std::move(group));
  }
  return result;
}

/// A file that is gone at the end.
struct Temporary {
  std::filesystem::path file;
  Temporary() {
    static std::atomic<int> count = 0;
    file = std::filesystem::temp_directory_path() /
           ("hextwist-" + std::to_string(getpid()) + "-" + std::to_string(count++) + ".brep");
  }
  Temporary(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
};

/// Are all volumes with elements OpenCASCADE's?
bool has_cad(const GmshModel& read) {
  gmsh::vectorpair solids;
  model::occ::getEntities(solids, 3);
  return std::ranges::all_of(read.entities, [&](const GmshEntity& entity) {
    return entity.dim < 3 || entity.element_types.empty() ||
           std::ranges::find(solids, std::pair(3, entity.tag)) != solids.end();
  });
}

/// On geometry of Gmsh's own, where Gmsh can tell: not on ruled surfaces.
void find_parameters(GmshEntity& entity) {
  std::string type;
  model::getType(entity.dim, entity.tag, type);
  if (entity.dim == 2 && type != "Plane") return;
  try {
    model::getParametrization(entity.dim, entity.tag, entity.coord, entity.parametric);
  } catch (...) {
    entity.parametric.clear();  // they are no duty
  }
}

void replace(const std::vector<GmshEntity>& entities) {
  // Boundaries can be cleared once nothing that they bound has elements.
  for (int dim = 3; dim >= 0; --dim)
    for (const GmshEntity& entity : entities)
      if (entity.dim == dim) mesh::clear({{dim, entity.tag}});
  for (const GmshEntity& entity : entities)
    if (!entity.node_tags.empty())
      mesh::addNodes(entity.dim, entity.tag, entity.node_tags, entity.coord, entity.parametric);
  for (const GmshEntity& entity : entities)
    if (!entity.element_types.empty())
      mesh::addElements(entity.dim, entity.tag, entity.element_types, entity.element_tags, entity.element_nodes);
}

}  // namespace

GmshLink take_from_gmsh(Session& session) {
  const GmshModel read = asking("the mesh can't be read", read_model);
  const Temporary brep;
  const bool cad = asking("the CAD can't be written", [&] {
    if (!has_cad(read)) return false;
    gmsh::write(brep.file.string());
    return true;
  });
  return take_gmsh(session, read, cad ? brep.file : std::filesystem::path());
}

void put_into_gmsh(const Session& session, const GmshLink& link) {
  std::vector<GmshEntity> fresh = put_gmsh(session, link), before;
  asking("the mesh can't be put back", [&] {
    for (GmshEntity& entity : fresh) {
      before.push_back(read_entity(entity.dim, entity.tag));
      if (entity.parametric.empty() && !before.back().parametric.empty()) find_parameters(entity);
    }
    try {
      replace(fresh);
    } catch (...) {
      replace(before);
      throw;
    }
  });
}

void refine_gmsh(std::string_view commands, SessionCallbacks callbacks) {
  Session session;
  session.set_callbacks(std::move(callbacks));
  const GmshLink link = take_from_gmsh(session);
  session.run(commands);
  put_into_gmsh(session, link);
}

}  // namespace hextwist
