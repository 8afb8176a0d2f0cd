#include "corpus/run.h"

#include <chrono>
#include <cmath>
#include <optional>

#include "corpus/requests.h"
#include "corpus/same.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/session/session.h"
#include "support/association_checkers.h"
#include "support/checkers.h"
#include "support/same_meshed.h"

namespace hextwist::corpus {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Runs {
 public:
  Runs(const Input& input, const Plan& plan, const std::function<void(const Row&)>& begin,
       const std::function<void(const Row&)>& end)
      : input_(input), plan_(plan), begin_(begin), end_(end) {
    SessionCallbacks callbacks;
    callbacks.progress = [this](const char*, double) { return Clock::now() < deadline_; };
    session_.set_callbacks(std::move(callbacks));
  }

  void all() {
    session_.run("set max_memory 3");
    if (!read()) return;
    const std::int64_t most = std::max(plan_.max_hexes, 2 * std::int64_t{session_.meshed().mesh.n_hexes()});
    session_.run("set max_hexes " + std::to_string(most));
    start_.emplace(session_.meshed());
    for (run_ = plan_.first_run; run_ <= plan_.n_runs; ++run_) one();
  }

 private:
  bool read() {
    unused_ = test::UnusedNodes::allowed;
    hanging_ = test::HangingNodes::allowed;
    if (!input_.cad.empty() && !command("import geometry \"" + input_.cad.string() + "\"")) return false;
    if (!command("import mesh \"" + input_.mesh.string() + "\"")) return false;
    const auto& [mesh, model, association] = session_.meshed();
    const CommandRecord& record = session_.records().back();
    first_ = record.after.scaled_jacobian.min;
    // A mesh may lie as far off a loose CAD as this allows.
    tolerance_ = std::max(1e-7, 2 * record.off_cad.max_relative);
    unused_ = test::conformal(mesh) ? test::UnusedNodes::refused : test::UnusedNodes::allowed;
    hanging_ = has_doubled_nodes(mesh) ? test::HangingNodes::allowed : test::HangingNodes::refused;
    return true;
  }

  /// Two rounds of refinement, then what else there is; in the end all of it is undone.
  void one() {
    // A run is the same whatever was run before.
    random_.seed(plan_.seed * 1000 + static_cast<unsigned>(run_));
    n_done_ = 0;
    groups();
    refine(run_ - 1);
    if (run_ % 2) command("coarsen hex in node " + some_node() + " levels 2");
    refine(any_kind());
    if (run_ % 3 == 0) command("smooth volume all iterations 3");
    write();
    command("coarsen hex all");
    if (run_ % 4 == 0) refine(any_kind());
    undo();
  }

  /// Something to be carried: of a surface, and within the mesh.
  void groups() {
    const std::string surface =
        std::to_string(1 + random_() % static_cast<unsigned>(session_.meshed().model->count(2)));
    command("nodeset 90001 surface " + surface + " name \"a b\"");
    command("sideset 90002 surface " + surface);
    command("block 90003 hex in node " + some_node() + " name \"core\"");
  }

  int any_kind() { return static_cast<int>(random_() % static_cast<unsigned>(n_requests())); }

  void refine(int kind) {
    request_ = kind % n_requests();
    command(request(kind, session_.meshed(), random_));
    request_ = -1;
  }

  std::string some_node() {
    const Mesh& mesh = session_.meshed().mesh;
    return std::to_string(node_id(mesh, static_cast<Index>(random_() % static_cast<unsigned>(mesh.n_nodes()))));
  }

  Row begin(const std::string& command) {
    Row row;
    row.run = run_;
    row.request = request_;
    row.command = command;
    row.first_scaled_jacobian = first_;
    begin_(row);
    return row;
  }

  /// Runs and judges it. Was it done?
  bool command(const std::string& text) {
    Row row = begin(text);
    const MeshedModel before = session_.meshed();
    const auto began = Clock::now();
    deadline_ = began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(plan_.seconds));
    try {
      session_.run(text);
      ++n_done_;
    } catch (const CommandError& error) {
      row.said = error.message();
      row.outcome = outcome_of(row.said);
    }
    row.seconds = seconds_since(began);
    const MeshState& after = session_.records().back().after;
    row.hexes = after.hexes;
    row.scaled_jacobian = after.scaled_jacobian.min;
    row.shape = after.shape.min;
    const auto judged = row.outcome == Outcome::ok ? promises() : unchanged(before);
    if (!judged) {
      row.said = judged.message() + (row.said.empty() ? "" : std::string(" after: ") + row.said);
      row.outcome = Outcome::broken;
    }
    end_(row);
    return row.outcome == Outcome::ok;
  }

  static Outcome outcome_of(const std::string& said) {
    const auto has = [&](const char* text) { return said.find(text) != std::string::npos; };
    if (has("would be no good")) return Outcome::dropped;
    if (has("that are allowed") || has("max_memory") || has("out of memory") || said == "cancelled")
      return Outcome::limited;
    return Outcome::refused;
  }

  testing::AssertionResult unchanged(const MeshedModel& before) const {
    return test::same_bits(before, session_.meshed());
  }

  /// How far faces leave their surfaces: so far coarse hexes reach out of the model, and what is cut out of them.
  static double bulge(const MeshedModel& meshed) {
    const auto& [mesh, model, association] = meshed;
    double most = 0;
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i) {
      const auto [hex, face] = association.surface_faces[i];
      const Quad quad = face_node_cycle(mesh.hexes[hex], face);
      const Owner surface{2, association.face_surface[i]};
      const auto look_at = [&](const Vec3& place) { most = std::max(most, model->project(surface, place).distance); };
      Vec3 middle = Vec3::Zero();
      for (std::size_t c = 0; c < 4; ++c) {
        middle += mesh.points[quad[c]] / 4;
        look_at((mesh.points[quad[c]] + mesh.points[quad[(c + 1) % 4]]) / 2);
      }
      look_at(middle);
    }
    return most;
  }

  testing::AssertionResult promises() const {
    const auto& [mesh, model, association] = session_.meshed();
    if (mesh.n_hexes() == 0) return testing::AssertionSuccess();
    if (auto result = test::conformal(mesh, unused_, hanging_); !result) return result;
    if (auto result = test::uninverted(mesh); !result) return result;
    if (auto result = test::sets_valid(mesh); !result) return result;
    if (auto result = test::complete(mesh, association, *model); !result) return result;
    if (test::on_model(mesh, association, *model, tolerance_)) return testing::AssertionSuccess();
    return test::on_model(mesh, association, *model, tolerance_, bulge(session_.meshed()));
  }

  /// In one format after the other, from run to run.
  void write() {
    const FileKind& kind = file_kinds()[static_cast<std::size_t>(run_) % file_kinds().size()];
    const auto file = plan_.folder / kind.name;
    const std::string text = "export mesh \"" + file.string() + "\" overwrite " + kind.options;
    if (!command(text)) return;
    Row row = begin("import mesh \"" + file.string() + "\"");
    const auto began = Clock::now();
    try {
      row.said = difference(session_.meshed().mesh, read_mesh(file).mesh, kind);
    } catch (const std::exception& error) {
      row.said = error.what();
    }
    row.seconds = seconds_since(began);
    row.outcome = row.said.empty() ? Outcome::ok : Outcome::broken;
    row.hexes = session_.meshed().mesh.n_hexes();
    end_(row);
    std::filesystem::remove(file);
  }

  void undo() {
    Row row = begin("undo");
    deadline_ = Clock::time_point::max();
    testing::AssertionResult same = test::same_bits(*start_, session_.meshed());
    const auto began = Clock::now();
    for (int step = 0; !same && step < n_done_; ++step) {
      try {
        session_.run("undo");
      } catch (const CommandError& error) {
        same = testing::AssertionFailure() << error.message();
        break;
      }
      same = test::same_bits(*start_, session_.meshed());
    }
    row.seconds = seconds_since(began);
    row.hexes = session_.meshed().mesh.n_hexes();
    if (!same) {
      row.said = same.message();
      row.outcome = Outcome::broken;
    }
    end_(row);
  }

  const Input& input_;
  const Plan& plan_;
  const std::function<void(const Row&)>&begin_, &end_;
  Session session_;
  Clock::time_point deadline_;
  std::optional<MeshedModel> start_;
  std::mt19937 random_;
  double tolerance_ = 1e-7, first_ = 0;
  test::UnusedNodes unused_ = test::UnusedNodes::refused;
  test::HangingNodes hanging_ = test::HangingNodes::refused;
  int run_ = 0, request_ = -1, n_done_ = 0;
};

}  // namespace

const char* name(Outcome outcome) {
  constexpr const char* names[] = {"ok", "refused", "dropped", "limited", "broken"};
  return names[static_cast<int>(outcome)];
}

void run(const Input& input, const Plan& plan, const std::function<void(const Row&)>& begin,
         const std::function<void(const Row&)>& end) {
  Runs(input, plan, begin, end).all();
}

}  // namespace hextwist::corpus
