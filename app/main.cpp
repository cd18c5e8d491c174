// The `shoal` command: its grammar, and errors as one line with an exit code.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/messages.h"
#include "app/output.h"
#include "core/error.h"

namespace shoal::app {
namespace {

constexpr int kExitDone = 0, kExitFailed = 1, kExitUsage = 2;
constexpr const char* kCommands = "render, compare, diff, probe, scene, info, list";

int report(const std::string& what, int code) {
  std::fputs(one_line("shoal: error: " + what).c_str(), stderr);
  return code;
}

void add_text_option(CLI::App& command, const char* name, std::optional<std::string>& value, const char* help,
                     const char* type) {
  command.add_option(name, value, help)->type_name(type)->expected(1);
}

void add_scene_options(CLI::App& command, RawOptions& raw) {
  command.add_option("SCENE", raw.scene, "a .gltf or .glb file, or a built-in scene (shoal list scenes)")
      ->required()
      ->type_name("");
  add_text_option(command, "--triangles", raw.triangles, "size of a built-in scene, met within 10 %", "N");
  command.add_flag("--quiet", raw.quiet, "no warnings, no progress");
}

void add_set_option(CLI::App& command, RawOptions& raw) {
  command
      .add_option("--set", raw.set,
                  "a method's option (METHOD.KEY names whose), or a water key: size=X,Z depth ior "
                  "absorption=R,G,B surface geometry; again for more")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

using AddOption =
    std::function<void(const char* name, std::optional<std::string>& value, const char* type, const char* help)>;

AddOption adder(CLI::App& command) {
  return [&command](const char* name, std::optional<std::string>& value, const char* type, const char* help) {
    add_text_option(command, name, value, help, type);
  };
}

// What a frame is, for every command that draws one.
void add_picture_options(CLI::App& command, RawOptions& raw) {
  const AddOption add = adder(command);
  add("--size", raw.size, "WxH", "pixels, each side 1 to 16384; 1280x720");
  add("--spp", raw.spp, "N", "samples a pixel, 1 to 256; 1 is the pixel's centre");
  add("--camera", raw.camera, "NAME|INDEX", "the first in node order");
  add("--time", raw.time, "S", "seconds; 0");
  add("--step", raw.step, "S", "frame k has the time + k steps; 1/60");
  add("--threads", raw.threads, "N", "all that the process may use");
  add("--tile", raw.tile, "N", "pixels, a power of two, 16 to 256; 64");
  add("--isa", raw.isa, "NAME", "instruction set (shoal list isas); the best");
  add("--anisotropy", raw.anisotropy, "N", "probes along the longer side of a pixel in a texture, 1 to 16; 1");
  add("--shadows", raw.shadows, "off|map|rays", "of the sun; map");
  add("--shadow-map", raw.shadow_map, "N", "texels a side of the sun's shadow map, a power of two, 256 to 8192; 4096");
  add("--reflections", raw.reflections, "environment|planar|traced",
      "planar for methods of the categories raster and volume, traced for the others");
  add("--exposure", raw.exposure, "STOPS", "of the PNG; 0");
  add("--tonemap", raw.tonemap, "none|aces", "of the PNG; none");
  add("--background", raw.background, "R,G,B|environment",
      "what every ray sees that leaves the scene: linear light, or "
      "the scene's environment (the default sky where it has none); the scene's");
  add("--environment", raw.environment, "FILE",
      "equirectangular picture (.hdr .exr .png .jpg) that surrounds and lights the scene; the scene's");
  add("--cache", raw.cache, "DIR", "where filtered environments are kept; $XDG_CACHE_HOME/shoal or ~/.cache/shoal");
  command.add_flag("--no-cache", raw.no_cache, "filter the environment anew and keep nothing");
}

void add_frame_options(CLI::App& command, RawOptions& raw) {
  const AddOption add = adder(command);
  add("--method", raw.method, "NAME", "how water is refracted (shoal list methods); two-phase");
  add("--methods", raw.methods, "A,B", "of shoal compare");
  add("--reference", raw.reference, "NAME", "of shoal compare");
  add_picture_options(command, raw);
  add("--frames", raw.frames, "A:B", "frames A to B, both included, into -o frame.%04d.png");
  add("--warmup", raw.warmup, "N", "uncounted frames before repeated ones; 3");
  add("--repeat", raw.repeat, "N",
      "time N frames, frame k seen by the camera turned k x 0.1 degree left; picture and digests are frame 0's; 1");
  add("--aov", raw.aov, "A,B", "more layers in an EXR: depth, normal, hit.position, id.triangle, ...");
  add("--json", raw.json, "FILE", "the report; - is standard output, after the digests");
  command.add_flag("--digest", raw.digest, "print `digest STAGE HEX` for each stage, frame after frame");
  add_set_option(command, raw);
}

void add_compare_options(CLI::App& command, CompareArguments& compare) {
  RawOptions& raw = compare.options;
  const AddOption add = adder(command);
  add("-o", raw.output, "DIR", "the folder: report.html, metrics.json, pictures; made where there is none");
  add("--methods", raw.methods, "A,B", "all but the reference (shoal list methods)");
  add("--reference", raw.reference, "NAME",
      "the method that the others are compared with; ray-traced, or hybrid in a build without it");
  add_picture_options(command, raw);
  add("--warmup", raw.warmup, "N", "uncounted frames before repeated ones; 3");
  add("--repeat", raw.repeat, "N",
      "time N frames of each method, frame k seen by the camera turned k x 0.1 degree left; 5");
  add("--sweep", compare.sweep, "KEY=A,B,C",
      "also compare at each value, with curves: a key of --set, or view-angle (degrees between the camera's axis and "
      "the "
      "water), triangles, time, spp, size, ...");
  add("--ppd", compare.ppd, "N", "pixels a degree, for FLIP; 67.02");
  command.add_flag("--yee", compare.yee, "Yee's metric too; slow");
  command.add_flag("--exr", compare.exr, "each method's frame as an EXR too, with its hit buffers");
  add("--aov", raw.aov, "A,B", "more layers of those");
  add_set_option(command, raw);
}

void add_diff_options(CLI::App& command, DiffArguments& diff) {
  command.add_option("A", diff.a, "a PNG or an EXR")->required()->type_name("");
  command.add_option("B", diff.b, "another of the same kind and size")->required()->type_name("");
  add_text_option(command, "--json", diff.json, "the report; - is standard output, instead of the text", "FILE");
  add_text_option(command, "--mask", diff.mask, "only pixels that are not black in it (not 0 in its water.mask)",
                  "FILE");
  add_text_option(command, "--map", diff.map, "write the absolute differences", "FILE.png|FILE.exr");
  add_text_option(command, "--flip-map", diff.flip_map, "write FLIP's error: in colours, or as it is",
                  "FILE.png|FILE.exr");
  add_text_option(command, "--ppd", diff.ppd, "pixels a degree, for FLIP; 67.02", "N");
  command.add_flag("--quiet", diff.quiet, "no text, only the exit code");
}

// What the command line grammar refuses, as one of our errors.
std::string parse_error_text(const CLI::ParseError& error, const CLI::App& root) {
  std::string command = "shoal";
  for (const CLI::App* parsed : root.get_subcommands()) command += " " + parsed->get_name();
  return std::string(error.what()) + "; expected what '" + command + " --help' shows";
}

// The command line as a shell would take it.
std::string command_line(int argc, char** argv) {
  std::string line = "shoal";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                            "0123456789-_=.,:/+@%") == std::string::npos;
    line += ' ';
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

bool has_command(CLI::App& root, const std::string& name) {
  const std::vector<CLI::App*> commands = root.get_subcommands([](CLI::App*) { return true; });
  return std::any_of(commands.begin(), commands.end(), [&](const CLI::App* c) { return c->get_name() == name; });
}

int run(int argc, char** argv) {
  CLI::App root(
      "Shoal: water refraction, rasterized to the bit.\n"
      "Exit codes: 0 done, 1 input or machine failed, 2 wrong usage; diff: 0 equal, 3 different.",
      "shoal");
  root.set_version_flag("--version", "shoal " SHOAL_VERSION);
  RawOptions raw;
  CompareArguments compare;
  DiffArguments diff;
  ProbeArguments probe;
  std::string kind;
  bool verbose = false;

  CLI::App& render = *root.add_subcommand("render", "one frame, or a run of frames, to PNG or EXR");
  add_scene_options(render, raw);
  add_text_option(render, "-o", raw.output, "the picture; may be left out with --json or --digest",
                  "FILE.png|FILE.exr");
  add_frame_options(render, raw);

  CLI::App& compare_command =
      *root.add_subcommand("compare", "methods side by side against a reference: report, numbers, pictures");
  add_scene_options(compare_command, compare.options);
  add_compare_options(compare_command, compare);
  compare.command = command_line(argc, argv);

  CLI::App& diff_command = *root.add_subcommand("diff", "two pictures: equal, or the first difference");
  add_diff_options(diff_command, diff);

  CLI::App& probe_command = *root.add_subcommand("probe", "what every stage makes of one pixel or world point");
  add_scene_options(probe_command, probe.options);
  add_text_option(probe_command, "--pixel", probe.pixel, "of the frame, 0,0 the top left one", "X,Y");
  add_text_option(probe_command, "--point", probe.point, "metres, world", "X,Y,Z");
  add_frame_options(probe_command, probe.options);

  CLI::App& scene = *root.add_subcommand("scene", "write a built-in scene");
  add_scene_options(scene, raw);
  add_text_option(scene, "-o", raw.output, "the file", "FILE.glb");

  CLI::App& info = *root.add_subcommand("info", "what is in a scene");
  add_scene_options(info, raw);
  add_set_option(info, raw);
  info.add_option("--json", raw.json, "as JSON to FILE, or to standard output")->type_name("[FILE]")->expected(0, 1);

  CLI::App& list = *root.add_subcommand("list", "names, one a line");
  list.add_option("KIND", kind, "methods, surfaces, scenes or isas")->required()->type_name("");
  list.add_flag("--verbose", verbose, "methods: with the options of each");

  if (argc < 2) return report(std::string("no command; expected one of: ") + kCommands, kExitUsage);
  const std::string first = argv[1];
  if (first.rfind("-", 0) != 0 && !has_command(root, first)) {
    return report("command '" + first + "': unknown; expected one of: " + kCommands, kExitUsage);
  }
  try {
    root.parse(argc, argv);
  } catch (const CLI::Success& help) {  // --help, --version: not an error
    std::ostringstream out, ignored;
    root.exit(help, out, ignored);
    write_stdout(out.str());
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    return report(parse_error_text(error, root), kExitUsage);
  }
  if (render) return run_render(raw);
  if (compare_command) return run_compare(compare);
  if (diff_command) return run_diff(diff);
  if (probe_command) return run_probe(probe);
  if (scene) return run_scene(raw);
  if (info) return run_info(raw);
  if (list) return run_list(kind, verbose);
  return report(std::string("no command; expected one of: ") + kCommands, kExitUsage);
}

int run_and_report(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    return report(error.what(), kExitUsage);
  } catch (const std::bad_alloc&) {
    return report("out of memory; expected a smaller scene or frame, or a larger machine", kExitFailed);
  } catch (const std::exception& error) {
    return report(error.what(), kExitFailed);
  }
}

}  // namespace
}  // namespace shoal::app

int main(int argc, char** argv) {
  shoal::app::remove_partial_outputs_on_signals();
  return shoal::app::run_and_report(argc, argv);
}
