#include "files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <iterator>

#include "blackleaf/error.h"

namespace fs = std::filesystem;

namespace blackleaf::cli {
namespace {

// docs/FILE_FORMAT.md: the first four bytes say "octree", the next four show damage by transfers that take it for text.
constexpr std::ptrdiff_t kMagicBytes = 4;

// Opening a pipe by its name waits until somebody writes to it, for ever if nobody does. The names that shells give to
// open pipes are harmless.
void refuse_named_pipe(const std::string& path) {
  std::error_code error;
  if (!fs::is_fifo(path, error) || path.starts_with("/dev/") || path.starts_with("/proc/")) return;
  throw Error(ErrorCode::io, fmt::format("'{}' is a named pipe, which may keep us waiting for ever", path),
              fmt::format("give - for standard input and redirect it: < {}", path));
}

}  // namespace

Option* add_octree_input(App& app, const std::string& name, std::string& target, const std::string& description) {
  return app.add_option(name, target, description)->required()->type_name("");
}

Option* add_output(App& app, std::string& target, const std::string& description) {
  return app.add_option("-o,--output", target, description)->required()->type_name("OUT");
}

std::string base_name(const std::string& path) {
  if (path == "-") return "standard input";
  const fs::path name(path);
  return name.has_filename() ? name.filename().string() : name.parent_path().filename().string();  // folder/
}

std::string suffix_of(const std::string& path) {
  std::string name = fs::path(path).filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".nii.gz")) return ".nii.gz";
  return fs::path(name).extension().string();
}

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, 1, ',');
  return digits;
}

std::optional<std::uint64_t> size_of(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const std::uintmax_t size = fs::file_size(path, error);
  return error ? std::nullopt : std::optional<std::uint64_t>(size);
}

std::string counted(std::uint64_t number, const std::string& noun) {
  return grouped(number) + " " + noun + (number == 1 ? "" : "s");
}

void check_input(const std::string& path, const std::string& what) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found || path.empty())
    throw Error(ErrorCode::io, fmt::format("there is no file '{}'", path), "check the name");
  if (status.type() == fs::file_type::none)
    throw Error(ErrorCode::io, fmt::format("cannot look at '{}': {}", path, error.message()), "check the name");
  if (status.type() == fs::file_type::directory)
    throw Error(ErrorCode::io, fmt::format("'{}' is a folder, not {}", path, what), "name a file in it");
  if (access(path.c_str(), R_OK) != 0)
    throw Error(ErrorCode::io, fmt::format("'{}' may not be read", path), "change its permissions");
}

void check_plain_input(const std::string& path, const std::string& what) {
  check_input(path, what);
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw Error(ErrorCode::io, fmt::format("'{}' is a device or a pipe, not {}", path, what), "name an ordinary file");
}

void check_input_or_folder(const std::string& path, const std::string& what) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return check_plain_input(path, what);
  if (access(path.c_str(), R_OK | X_OK) != 0)
    throw Error(ErrorCode::io, fmt::format("folder '{}' may not be read", path), "change its permissions");
}

void check_output(const std::string& path) {
  if (path.empty()) throw Error(ErrorCode::bad_argument, "the output's name is empty", "give one after -o");
  std::error_code error;
  if (fs::is_directory(path, error))
    throw Error(ErrorCode::io, fmt::format("cannot write '{}': it is a folder", path), "name a file in it");
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw Error(ErrorCode::io, fmt::format("cannot write '{}': there is no folder '{}'", path, folder.string()),
                "make the folder first");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(ErrorCode::io,
                fmt::format("cannot write '{}': folder '{}' may not be written to", path, folder.string()),
                "change its permissions or name another output");
}

void check_octree_input(const std::string& path) {
  check_input(path, "an octree file");
  refuse_named_pipe(path);
}

void check_octree_output(const Session& session, const std::string& path) {
  if (path == "-") {
    if (session.machine().is_shared())
      throw Error(ErrorCode::bad_argument, "many processes cannot write one standard output", "name a file after -o");
    if (session.json())
      throw Error(ErrorCode::bad_argument, "-o - and --json both want standard output", "write the octree to a file");
    if (isatty(STDOUT_FILENO) == 1)
      throw Error(ErrorCode::bad_argument, "an octree is not text for a terminal", "redirect standard output");
    return;
  }
  constexpr std::array<const char*, 14> kOthers = {".nrrd", ".nhdr", ".nii", ".nii.gz", ".mha", ".mhd",  ".stl",
                                                   ".obj",  ".ply",  ".svg", ".png",    ".pdf", ".json", ".runs"};
  const std::string suffix = suffix_of(path);
  if (std::find(kOthers.begin(), kOthers.end(), suffix) != kOthers.end())
    throw Error(ErrorCode::bad_argument,
                fmt::format("'{}' would be an octree, but its suffix {} says otherwise", path, suffix),
                "name it *.octree, then use blackleaf export or draw");
  check_output(path);
}

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  const bool standard = path == "-";
  if (!standard) {
    check_input(path, "a file");
    refuse_named_pipe(path);
  }
  const std::string name = standard ? "standard input" : "'" + path + "'";
  struct Descriptor {
    int number;
    ~Descriptor() {
      if (number > STDIN_FILENO) close(number);
    }
  };
  const Descriptor file{standard ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) throw Error(ErrorCode::io, fmt::format("cannot open {}", name), "check its permissions");
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 1 << 16> part{};
  for (;;) {
    check_interrupt();
    const ssize_t count = read(file.number, part.data(), part.size());
    if (count == 0) break;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error(ErrorCode::io, fmt::format("cannot read {}", name), "check the disk");
    bytes.insert(bytes.end(), part.begin(), part.begin() + count);
  }
  return bytes;
}

bool is_octree_data(const std::vector<std::uint8_t>& bytes) {
  // The magic is what every octree file begins with, so any octree shows it.
  static const std::vector<std::uint8_t> sample = to_bytes(Octree());
  return std::ssize(bytes) >= kMagicBytes && std::equal(sample.begin(), sample.begin() + kMagicBytes, bytes.begin());
}

OctreeFile read_octree(Session& session, const std::string& path) {
  return session.stage("read", [&](const Work&) { return session.machine().load(path); });
}

Octree read_beside(Session& session, const Octree& first, const std::string& first_name, const std::string& name,
                   const Label& label, const std::string& remedy) {
  if (first_name == "-" && name == "-")
    throw Error(ErrorCode::bad_argument, "both octrees are - for standard input", "name a file for one of them");
  Octree next = read_solid(session, name, label);
  check_one_universe(session, first, first_name, next, name, remedy);
  return next;
}

void check_one_universe(const Session& session, const Octree& first, const std::string& first_name, const Octree& next,
                        const std::string& name, const std::string& remedy) {
  if (first.depth() != next.depth())
    throw Error(ErrorCode::bad_argument,
                fmt::format("'{}' has depth {} and '{}' has depth {}", first_name, first.depth(), name, next.depth()),
                remedy);
  if (!first.frame().same_as(next.frame()))
    session.warn(
        fmt::format("'{}' and '{}' have different frames; they are compared voxel by voxel as if both had "
                    "that of the first",
                    first_name, name));
}

void check_lattice(const Octree& first, const std::string& first_name, const Octree& other, const std::string& name) {
  if (!whole_shift(other.frame(), first.frame()))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--align: the voxels of '{}' do not lie on those of '{}' in the world", name, first_name),
                "build it with the other's frame, with build --like");
}

void check_voxel_sizes(const Octree& first, const std::string& first_name, const Octree& other,
                       const std::string& name) {
  const auto text = [](const Frame& frame) {
    const Eigen::Vector3d size = frame.axes.colwise().norm();
    return size.isApproxToConstant(size.x(), 1e-9)
               ? fmt::format("{:.10g} {}", size.x(), frame.unit)
               : fmt::format("{:.10g} x {:.10g} x {:.10g} {}", size.x(), size.y(), size.z(), frame.unit);
  };
  const Eigen::Vector3d a = first.frame().axes.colwise().norm(), b = other.frame().axes.colwise().norm();
  if (!a.isApprox(b, 1e-6) || first.frame().unit != other.frame().unit)
    throw Error(ErrorCode::bad_argument,
                fmt::format("the voxels of '{}' measure {} and those of '{}' {}", first_name, text(first.frame()), name,
                            text(other.frame())),
                "put the second on the voxels of the first with --resample");
}

void warn_if_empty(const Session& session, const Octree& octree) { warn_if_empty(session, Made{octree}); }

void warn_if_empty(const Session& session, const Made& made) {
  if (session.machine().is_empty(made)) session.warn("no voxel is black");
}

std::string metadata_text(const Session& session, const std::string& source, const Json& options) {
  const Json metadata = {{"program", "blackleaf"},
                         {"version", BLACKLEAF_VERSION},
                         {"source", base_name(source)},
                         {"command", session.command()},
                         {"options", options}};
  return metadata.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_octree_bytes(Session& session, const std::function<std::vector<std::uint8_t>()>& bytes) {
  session.write_stage([&] {
    const std::vector<std::uint8_t> made = bytes();
    check_interrupt();
    print_out(std::string(made.begin(), made.end()));
  });
}

void write_octree(Session& session, const Octree& octree, const std::string& path, const std::string& source,
                  const Json& options, const Json& more, const std::string& before) {
  write_octree(session, Made{octree}, path, source, options, more, before);
}

void write_octree(Session& session, const Made& made, const std::string& path, const std::string& source,
                  const Json& options, const Json& more, const std::string& before) {
  Machine& machine = session.machine();
  const std::string text = metadata_text(session, source, options);
  if (path == "-") {
    print_octree_bytes(session, [&] { return to_bytes(made.octree, text); });
    return;
  }
  const bool telling = session.json() || !session.quiet();
  Told told;
  if (telling) told = session.stage("measure", [&](const Work&) { return machine.tell_of(made); });
  session.write_stage([&] { machine.save(made, path, text); });
  if (!before.empty()) print_out(before);
  if (!telling) return;
  const std::optional<std::uint64_t> file_bytes = size_of(path);
  if (session.json()) {
    Json report = {{"output", path},
                   {"depth", made.octree.depth()},
                   {"volume", told.volume},
                   {"black_leaves", told.black_leaves},
                   {"internal_nodes", told.internal_nodes},
                   {"memory_bytes", told.memory_bytes},
                   {"file_bytes", file_bytes ? Json(*file_bytes) : Json()}};
    report.update(more);
    print_out(report);
    return;
  }
  print_out(fmt::format("{}: depth {}, {}, {}, {}{}\n", path, made.octree.depth(), counted(told.volume, "voxel"),
                        told.black_leaves == 1 ? "1 black leaf" : grouped(told.black_leaves) + " black leaves",
                        counted(told.internal_nodes, "internal node"),
                        file_bytes ? ", " + counted(*file_bytes, "byte") : ""));
}

}  // namespace blackleaf::cli
