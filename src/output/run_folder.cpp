#include "windlass/output/run_folder.hpp"

#include "run_files.hpp"
#include "windlass/output/branches_csv.hpp"
#include "windlass/output/checksum.hpp"
#include "windlass/output/error.hpp"

namespace windlass::output {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

/// Checks that a run may be written into the folder; nothing is made yet.
void check_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw OutputError("cannot make the run folder " + folder.string() + ": a file of that name exists");
  }
  if (fs::is_directory(folder, error) && !fs::is_empty(folder, error) && !force) {
    throw OutputError("the run folder " + folder.string() +
                      " exists and is not empty; use --force to replace the run in it, "
                      "or --out to write elsewhere");
  }
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError("cannot make the run folder " + folder.string() + ": " + error.message());
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw OutputError("cannot remove " + path.string() + ": " + error.message());
}

}  // namespace

RunWriter RunWriter::create(const fs::path& folder, const scene::Scene& scene, const WriterOptions& options) {
  check_folder(folder, options.force);
  const fs::path named = folder.has_filename() ? folder : folder.parent_path();  // without a slash at its end
  const bool fresh = !fs::exists(named);
  RunWriter writer;
  writer.folder_ = fresh ? fs::path(named.string() + ".part") : named;
  writer.info_.version = options.version;
  writer.info_.command = options.command;
  writer.info_.scene = scene.name;
  writer.info_.has_cylinder = scene.has_cylinder;
  writer.info_.parameter = options.parameter;
  writer.info_.extra_parameter = options.extra_parameter;
  writer.info_.options = options.options;
  writer.info_.machine = describe_machine();
  writer.save_every_ = options.save_every;
  writer.last_checkpoint_ = std::chrono::steady_clock::now();
  make_folder(writer.folder_);
  writer.lock_ = FolderLock(writer.folder_);
  // A mixture of the old run and the new must not be taken for a run: run.json goes first and comes last.
  for (const char* file : {info_file, checkpoint_file}) remove_file(writer.folder_ / file);
  writer.replace_stamped(scene_file, scene.resolved_toml);
  writer.rewrite_branches();
  writer.write_special_points();
  writer.started_ = true;
  writer.committed_ = std::string::npos;  // nothing is on disk yet
  writer.commit();
  if (fresh) {
    std::error_code error;
    fs::rename(writer.folder_, named, error);
    if (error) throw OutputError("cannot make the run folder " + named.string() + ": " + error.message());
    writer.folder_ = named;
    writer.branches_ = AppendFile(named / branches_file);
  }
  return writer;
}

namespace {

/// Drops what lies beyond the extent.
void cut(Run& run, const Extent& extent) {
  if (run.rows.size() < extent.points || run.points.size() < extent.points ||
      run.special_points.size() < extent.special_points ||
      run.info.lost_branches.size() < extent.lost_branches)
    throw OutputError("cannot go on with " + run.folder.string() +
                      ": its checkpoint knows of points that its other files do not hold");
  run.rows.resize(extent.points);
  run.special_points.resize(extent.special_points);
  run.info.lost_branches.resize(extent.lost_branches);
  if (run.points.size() > extent.points) run.points = run.points.first(extent.points);
}

}  // namespace

RunWriter RunWriter::resume(const fs::path& folder, const std::optional<Extent>& extent,
                            std::optional<double> save_every) {
  FolderLock lock(folder);
  Run run = read_run(folder);
  if (extent) cut(run, *extent);
  RunWriter writer;
  writer.folder_ = folder;
  writer.lock_ = std::move(lock);
  writer.started_ = true;
  writer.branches_text_ = read_file(folder / branches_file);
  writer.save_every_ = save_every;
  if (save_every) writer.set_pause();
  writer.info_ = std::move(run.info);
  writer.store_ = std::move(run.points);
  for (BranchRow& row : run.rows) {
    if (writer.store_.find(point_name(row.branch, row.point, ""))) writer.rows_.push_back(std::move(row));
  }
  for (SpecialPoint& point : run.special_points) {
    if (writer.store_.find(point.label)) writer.special_points_.push_back(std::move(point));
  }
  writer.committed_ = writer.store_.size();
  writer.last_commit_ = writer.last_checkpoint_ = std::chrono::steady_clock::now();
  // In this order a kill leaves no special point without its solution, and no solution without its row.
  writer.write_special_points();
  if (extent) writer.store_.write(folder / points_file);
  writer.rewrite_branches();
  writer.write_info();
  return writer;
}

void RunWriter::add_point(const BranchRow& row, const equilibrium::Solution& solution) {
  info_.status = "running";  // a finished run that only gets spectra stays finished
  store_.append({row.branch, row.point, row.label}, solution);
  rows_.push_back(row);
  const std::string line = csv_line(row, info_.has_cylinder, info_.extra_parameter);
  branches_.append(line);
  branches_text_ += line;
  if (std::chrono::steady_clock::now() - last_commit_ > pause_) commit();
}

void RunWriter::add_special_point(const SpecialPoint& point) {
  special_points_.push_back(point);
  special_stale_ = true;
  if (std::chrono::steady_clock::now() - last_commit_ >= special_pause_) commit();
}

void RunWriter::add_lost_branch(const LostBranch& lost) {
  info_.lost_branches.push_back(lost);
  write_info();
}

void RunWriter::set_stability(const std::string& name, const equilibrium::Stability& stability) {
  store_.set_stability(name, stability);
  const PointStore::Key& key = store_.keys()[*store_.find(name)];
  for (BranchRow& row : rows_) {
    if (row.branch != key.branch || row.point != key.point) continue;
    row.index = stability.index;
    if (!stability.eigenvalues.empty()) row.eigenvalue_1 = stability.eigenvalues.front();
  }
  committed_ = 0;  // the files on disk are out of date
  rows_stale_ = true;
}

void RunWriter::commit() {
  const auto begin = std::chrono::steady_clock::now();
  write_stale();
  last_commit_ = std::chrono::steady_clock::now();
  commit_takes_ = last_commit_ - begin;
  set_pause();
}

void RunWriter::write_stale() {
  // The solutions first: a special point that is listed can always be restarted from.
  if (committed_ != store_.size()) store_.write(folder_ / points_file);
  if (rows_stale_) rewrite_branches();
  if (special_stale_) write_special_points();
  write_info();
  committed_ = store_.size();
}

void RunWriter::set_pause() {
  // At most 5 % of the time of a run goes into rewriting points.h5 and the checkpoint.
  const std::chrono::duration<double> rare = 20.0 * (commit_takes_ + checkpoint_takes_);
  special_pause_ = save_every_ ? std::chrono::duration<double>(*save_every_) : rare;
  pause_ = save_every_ ? special_pause_ : std::max(std::chrono::duration<double>(1.0), rare);
}

void RunWriter::checkpoint(nlohmann::json state) {
  if (committed_ != store_.size() || special_stale_) commit();
  const auto begin = std::chrono::steady_clock::now();
  const nlohmann::json checkpoint = {{"points", store_.size()},
                                     {"special_points", special_points_.size()},
                                     {"lost_branches", info_.lost_branches.size()},
                                     {"state", std::move(state)}};
  std::vector<char> bytes;
  nlohmann::json::to_cbor(checkpoint, bytes);
  replace_file(folder_ / checkpoint_file, std::string_view(sealed({bytes.data(), bytes.size()})));
  last_checkpoint_ = std::chrono::steady_clock::now();
  checkpoint_takes_ = last_checkpoint_ - begin;
  set_pause();
}

void RunWriter::finish(const std::string& status, const Timings& timings, ordered_json summary) {
  info_.status = status;
  info_.timings = timings;
  info_.summary = std::move(summary);
  write_stale();
  if (status != "interrupted") remove_file(folder_ / checkpoint_file);
}

void RunWriter::rewrite_branches() {
  std::string text = csv_header(info_.has_cylinder, info_.extra_parameter);
  for (const BranchRow& row : rows_) text += csv_line(row, info_.has_cylinder, info_.extra_parameter);
  branches_text_ = text;
  replace_stamped(branches_file, text);
  branches_ = AppendFile(folder_ / branches_file);
  rows_stale_ = false;
}

void RunWriter::replace_stamped(const char* file, const std::string& text) {
  const Stamp stamp{text.size(), output::checksum(text)};
  info_.stamps[file].push_back(stamp);
  if (started_) write_info();
  replace_file(folder_ / file, std::string_view(text));
  info_.stamps[file] = {stamp};
}

void RunWriter::write_special_points() {
  ordered_json list = ordered_json::array();
  for (const SpecialPoint& point : special_points_) list.push_back(to_json(point));
  replace_stamped(special_file, list.dump(2) + "\n");
  special_stale_ = false;
}

void RunWriter::write_info() {
  // Rows that were appended since; while the file is being replaced, its stamps are those of replace_stamped.
  std::vector<Stamp>& rows = info_.stamps[branches_file];
  if (rows.size() == 1) rows = {{branches_text_.size(), output::checksum(branches_text_)}};
  replace_file(folder_ / info_file, std::string_view(info_text(info_)));
}

}  // namespace windlass::output
