#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "hextwist/embed/arrays.h"
#include "hextwist/embed/c_internal.h"

namespace hextwist::embed {
namespace {

struct LastError {
  std::string whole, message;
  int line = 0, column = 0;
};
thread_local LastError last_error;

AdaptOptions options_of(const hextwist_adapt_options* given) {
  if (!given) return {};
  if (given->method < HEXTWIST_AUTOMATIC || given->method > HEXTWIST_PARALLEL)
    throw Error("there is no method " + std::to_string(given->method));
  if (given->n_extensive < 0 || (given->n_extensive > 0 && !given->extensive))
    throw Error("the array of names of extensive fields is missing");
  std::vector<std::string> extensive;
  for (std::int64_t i = 0; i < given->n_extensive; ++i) {
    if (!given->extensive[i]) throw Error("the name of extensive field " + std::to_string(i) + " is missing");
    extensive.emplace_back(given->extensive[i]);
  }
  return {.keep_gradation = given->no_gradation == 0,
          .bias = given->bias == 0 ? 1 : given->bias,
          .method = static_cast<Method>(given->method),
          .concave = given->fill_concave ? Concave::fill : Concave::templates,
          .smooth = given->smooth != 0,
          .extensive = std::move(extensive)};
}

template <class T>
hextwist_status adapt(hextwist_session* session, const T* values, std::int64_t n, const hextwist_adapt_options* options,
                      std::int32_t** origin) {
  if (origin) *origin = nullptr;
  return with_session(session, [&](Session& s) {
    if (n < 0 || (n > 0 && !values)) throw Error("the array of flags or sizes is missing");
    const auto outcome = s.adapt(std::span(values, static_cast<std::size_t>(n)), options_of(options));
    if (origin) *origin = given_away(outcome.origin);
  });
}

}  // namespace

hextwist_status keep_error(const char* text) noexcept {
  try {
    last_error = {text, text};
  } catch (...) {
    last_error.whole.clear();  // no memory for the reason either
    last_error.message.clear();
  }
  return HEXTWIST_FAILED;
}

hextwist_status keep_error() noexcept {
  try {
    throw;
  } catch (const CommandError& error) {
    try {
      last_error = {error.what(), error.message(), error.line(), error.column()};
    } catch (...) {
      return keep_error("out of memory");
    }
    return error.message() == Cancelled().what() ? HEXTWIST_CANCELLED : HEXTWIST_FAILED;
  } catch (const std::bad_alloc&) {
    return keep_error("out of memory");
  } catch (const std::exception& error) {
    return keep_error(error.what());
  } catch (...) {
    return keep_error("unknown failure");
  }
}

}  // namespace hextwist::embed

using namespace hextwist;
using namespace hextwist::embed;

const char* hextwist_version(void) {
  return HEXTWIST_VERSION;
}

hextwist_session* hextwist_create(void) {
  hextwist_session* session = nullptr;
  guarded([&] { session = new hextwist_session; });
  return session;
}
void hextwist_free(hextwist_session* session) {
  delete session;
}

hextwist_status hextwist_run(hextwist_session* session, const char* commands) {
  return with_session(session, [&](Session& s) {
    if (!commands) throw Error("there are no commands: the pointer is null");
    s.run(commands);
  });
}

const char* hextwist_error(void) {
  return last_error.whole.c_str();
}
const char* hextwist_error_message(void) {
  return last_error.message.c_str();
}
int hextwist_error_line(void) {
  return last_error.line;
}
int hextwist_error_column(void) {
  return last_error.column;
}

hextwist_status hextwist_set_callbacks(hextwist_session* session, const hextwist_callbacks* callbacks) {
  return with_session(session, [&](Session& s) {
    SessionCallbacks to;
    if (callbacks) {
      const hextwist_callbacks given = *callbacks;
      if (given.output) to.output = [given](const std::string& line) { given.output(given.user, line.c_str()); };
      if (given.notice) to.notice = [given](const std::string& line) { given.notice(given.user, line.c_str()); };
      if (given.progress)
        to.progress = [given](const char* stage, double fraction) {
          return given.progress(given.user, stage, fraction) != 0;
        };
    }
    s.set_callbacks(std::move(to));
  });
}

hextwist_status hextwist_ids(hextwist_session* session, const char* kind, const char* range, std::int64_t** ids,
                             std::int64_t* n) {
  return with_session(session, [&](Session& s) {
    if (!kind || !ids || !n) throw Error("kind, ids and n are needed");
    const auto found = s.ids(kind, range ? range : "all");
    *ids = given_away(found);
    *n = static_cast<std::int64_t>(found.size());
  });
}
void hextwist_free_array(void* array) {
  std::free(array);
}

hextwist_mesh* hextwist_mesh_of(hextwist_session* session) {
  hextwist_mesh* mesh = nullptr;
  with_session(session, [&](Session& s) { mesh = new hextwist_mesh{.view = MeshView(s.share())}; });
  return mesh;
}
void hextwist_mesh_free(hextwist_mesh* mesh) {
  delete mesh;
}

hextwist_status hextwist_take(hextwist_session* session, const hextwist_arrays* arrays) {
  return with_session(session, [&](Session& s) {
    if (!arrays) throw Error("there are no arrays: the pointer is null");
    MeshFile file = mesh_from_arrays(*arrays);
    s.take_mesh(std::move(file.mesh), file.tags.empty() ? nullptr : &file.tags);
  });
}

hextwist_status hextwist_set_field(hextwist_session* session, const hextwist_field* field, std::int64_t n) {
  return with_session(session, [&](Session& s) {
    if (!field || !field->name || n < 0 || (n > 0 && !field->values))
      throw Error("a field with a name and values is needed");
    if (n / std::max(field->n_components, 1) > std::numeric_limits<Index>::max())
      throw Error("field '" + std::string(field->name) + "': " + std::to_string(n) +
                  " values are more than a mesh can have");
    s.set_field({field->name,
                 field->on_hexes ? Field::On::hex : Field::On::node,
                 field->n_components,
                 {field->values, field->values + n},
                 field->is_integer != 0});
  });
}

hextwist_status hextwist_adapt_flags(hextwist_session* session, const std::uint8_t* flags, std::int64_t n,
                                     const hextwist_adapt_options* options, std::int32_t** origin) {
  return adapt(session, flags, n, options, origin);
}
hextwist_status hextwist_adapt_levels(hextwist_session* session, const int8_t* changes, int64_t n,
                                      const hextwist_adapt_options* options, int8_t** kind, int32_t** first,
                                      int32_t** hexes) {
  if (kind) *kind = nullptr;
  if (first) *first = nullptr;
  if (hexes) *hexes = nullptr;
  return with_session(session, [&](Session& s) {
    if (n < 0 || (n > 0 && !changes)) throw Error("the array of changes is missing");
    const auto outcome = s.adapt(std::span(changes, static_cast<std::size_t>(n)), options_of(options));
    const CompressedRows rows = rows_of(outcome.came_from);
    std::vector<std::int8_t> kinds;
    for (const HexOrigin each : outcome.came_from.kind) kinds.push_back(static_cast<std::int8_t>(each));
    if (kind) *kind = given_away(kinds);
    if (first) *first = given_away(rows.first);
    if (hexes) *hexes = given_away(rows.items);
  });
}
hextwist_status hextwist_adapt_sizes(hextwist_session* session, const double* sizes, std::int64_t n,
                                     const hextwist_adapt_options* options, std::int32_t** origin) {
  return adapt(session, sizes, n, options, origin);
}
