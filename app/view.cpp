#include "view.h"

#include "hextwist/io/file.h"
#include "hextwist/session/core.h"
#include "hextwist/session/view/page.h"

namespace hextwist::app {
namespace {

SceneSource source_of(Session& session, const std::filesystem::path& file) {
  Session::Core& core = session.core();
  return {core.selector(), core.state, file.stem().string()};
}

}  // namespace

void write_view(const Options& options, Session& session, const std::function<void(const std::string&)>& say) {
  page_text();  // better said before the work
  Session before;
  if (!options.before.empty()) {
    if (!options.cad.empty()) before.import_cad(options.cad);
    before.import_mesh(options.before);
  }
  SceneSource source = source_of(session, !options.mesh.empty()     ? options.mesh
                                          : !options.levels.empty() ? options.levels
                                                                    : options.cad);
  Page made;
  if (options.before.empty()) {
    made = page(source, {.shows_cad = session.meshed().mesh.n_hexes() == 0});
  } else {
    const SceneSource other = source_of(before, options.before);
    source.before = [&]() -> const Mesh& { return other.selector.meshed.mesh; };
    made = page(source, {}, &other);
  }
  io::Output out(options.output, true);
  out << made.text;
  out.commit();
  for (const std::string& name : made.left_out)
    say("note: " + name + " is left out of " + options.output.string() + ", which would be too large");
  say(options.output.string() + ": open it in a browser");
}

}  // namespace hextwist::app
