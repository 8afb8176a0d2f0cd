// hextwist_corpus [--seed N] [--runs N] [--max-hexes N] [--seconds N] [--rows FILE] PLACE...
//
// Every mesh of these folders and files through whole sessions (run.h). Each in a process of its own with limits of
// time and memory, so that a crash or an endless loop is a row like any other. Exit status 1 when anything is broken.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "corpus/requests.h"
#include "corpus/summary.h"

namespace {

using namespace hextwist::corpus;

/// What the process says of a row: the fields, divided by what no text of ours has.
constexpr char separator = '\x1f';

std::string packed(const char* what, const Row& row) {
  std::string said = row.said;
  std::ranges::replace(said, '\n', ' ');
  std::ostringstream out;
  out.precision(17);
  for (const auto* text : {what, row.command.c_str(), said.c_str()}) out << text << separator;
  out << row.run << ' ' << row.request << ' ' << static_cast<int>(row.outcome) << ' ' << row.hexes << ' '
      << row.scaled_jacobian << ' ' << row.shape << ' ' << row.seconds << ' ' << row.first_scaled_jacobian << '\n';
  return out.str();
}

std::pair<std::string, Row> unpacked(const std::string& text) {
  std::istringstream in(text);
  std::string what;
  Row row;
  int outcome = 0;
  std::getline(in, what, separator);
  std::getline(in, row.command, separator);
  std::getline(in, row.said, separator);
  in >> row.run >> row.request >> outcome >> row.hexes >> row.scaled_jacobian >> row.shape >> row.seconds >>
      row.first_scaled_jacobian;
  row.outcome = static_cast<Outcome>(outcome);
  return {what, row};
}

void limit(int what, rlim_t to) {
  const rlimit limits{to, to};
  ::setrlimit(what, &limits);
}

[[noreturn]] void serve(const Input& input, const Plan& plan, int to) {
  limit(RLIMIT_AS, rlim_t{4} << 30);
  limit(RLIMIT_CORE, 0);
  const auto send = [&](const char* what, const Row& row) {
    // A command that looks at nobody's deadline is ended by the alarm.
    ::alarm(static_cast<unsigned>(4 * plan.seconds) + 60);
    const std::string text = packed(what, row);
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = ::write(to, text.data() + done, text.size() - done);
      if (n <= 0) ::_exit(3);
      done += static_cast<std::size_t>(n);
    }
  };
  try {
    run(
        input, plan, [&](const Row& row) { send("begin", row); }, [&](const Row& row) { send("end", row); });
  } catch (const std::exception& error) {
    std::cerr << input.mesh.string() << ": " << error.what() << "\n";
    ::_exit(4);
  }
  ::_exit(0);
}

/// All runs of one file. A process that ends before its time is followed by one that goes on with the next run.
void try_file(const Input& input, Plan plan, const std::function<void(const Row&)>& row_done) {
  while (plan.first_run <= plan.n_runs) {
    int pipe[2];
    if (::pipe(pipe) != 0) throw std::runtime_error("no pipe");
    const pid_t child = ::fork();
    if (child == 0) {
      ::close(pipe[0]);
      serve(input, plan, pipe[1]);
    }
    ::close(pipe[1]);
    std::string text;
    Row open;
    bool is_open = false;
    char buffer[4096];
    for (ssize_t n; (n = ::read(pipe[0], buffer, sizeof buffer)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(n));
      for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
        const auto [what, row] = unpacked(text.substr(0, end));
        is_open = what == "begin";
        if (is_open)
          open = row;
        else
          row_done(row);
      }
    }
    ::close(pipe[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (status == 0) return;
    open.outcome = Outcome::broken;
    open.said = WIFSIGNALED(status) ? std::string("ended by ") + ::strsignal(WTERMSIG(status))
                                    : "ended with status " + std::to_string(WEXITSTATUS(status));
    row_done(open);
    if (open.run == 0) return;  // it can't be read at all
    plan.first_run = open.run + 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Plan plan;
  plan.n_runs = n_requests();
  std::filesystem::path rows_file = "corpus.tsv";
  std::vector<std::filesystem::path> places;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) {
      places.emplace_back(word);
      continue;
    }
    const char* value = i + 1 < argc ? argv[++i] : "";
    if (word == "--seed")
      plan.seed = static_cast<unsigned>(std::atol(value));
    else if (word == "--runs")
      plan.n_runs = std::atoi(value);
    else if (word == "--max-hexes")
      plan.max_hexes = std::atol(value);
    else if (word == "--seconds")
      plan.seconds = std::atof(value);
    else if (word == "--rows")
      rows_file = value;
    else {
      std::cerr << "unknown option " << word << "\n";
      return 2;
    }
  }
  const std::vector<Input> inputs = find_inputs(places);
  if (inputs.empty()) {
    std::cerr << "no meshes\n";
    return 2;
  }
  plan.folder = std::filesystem::absolute(rows_file).parent_path() / "corpus-files";
  std::filesystem::create_directories(plan.folder);
  std::ofstream rows_out(rows_file);
  rows_out << header_line() << "\n";
  std::vector<FileRow> rows;
  for (const Input& input : inputs) {
    std::cerr << input.mesh.string() << "  " << input.cad.filename().string() << "\n";
    try_file(input, plan, [&](const Row& row) {
      rows.push_back({input, row});
      rows_out << line(rows.back(), plan.seed) << std::endl;
    });
  }
  std::cout << "seed " << plan.seed << ", " << inputs.size() << " meshes\n\n";
  print_summary(std::cout, rows);
  return std::ranges::any_of(rows, [](const FileRow& row) { return row.row.outcome == Outcome::broken; }) ? 1 : 0;
}
