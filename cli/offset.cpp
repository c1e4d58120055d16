// blackleaf offset: solids grown and shrunk by a ball; openings and closings.
#include "blackleaf/offset.h"

#include <cmath>

#include "blackleaf/error.h"
#include "commands.h"
#include "files.h"
#include "motion_options.h"
#include "options.h"

namespace blackleaf::cli {

int run_offset(Session& session) {
  Label label;
  std::string input, radius_text, output;
  bool open = false, close = false;
  LeavingOptions leaving;
  add_octree_input(session.app(), "FILE", input);
  session.app()
      .add_option("R", radius_text, "radius in voxels, like 2.5; a negative one shrinks the solid")
      ->required()
      ->type_name("");
  add_output(session.app(), output, "octree file to write, or - for standard output");
  Option* opening_flag =
      session.app().add_flag("--open", open, "shrink by R, then grow by R: thin parts and spikes vanish");
  session.app()
      .add_flag("--close", close, "grow by R, then shrink by R: holes and gaps are filled")
      ->excludes(opening_flag);
  leaving.add_to(session.app());
  add_label(session.app(), label);
  session.add_json();
  session.set_example("blackleaf offset bunny.octree 2.5 -o fat.octree");
  if (!session.parse()) return kDone;

  const double radius = parse_number("the radius R", radius_text);
  const bool grows = !open && !close && radius >= 0;
  if ((open || close) && radius < 0)
    throw Error(ErrorCode::bad_argument, "the radius of an opening or closing is " + radius_text,
                "give it without a sign");
  if (leaving.choice() != Leaving::error && !grows)
    throw Error(ErrorCode::bad_argument,
                "--" + leaving.name() + " is for solids that grow; this one stays in its universe", "leave it out");
  check_octree_output(session, output);
  const Octree source = read_solid(session, input, label);
  if (std::abs(radius) < 1)
    session.warn("a ball of radius " + radius_text + " holds no voxel centre but its own, so nothing changes");
  const Octree target = session.stage("offset", [&](const Work& work) {
    return open    ? opening(source, radius, work)
           : close ? closing(source, radius, work)
                   : offset(source, radius, leaving.choice(), work);
  });
  warn_if_empty(session, target);
  Json options = {{"radius", radius}};
  if (open || close) options["operation"] = open ? "open" : "close";
  if (grows) options["leaving"] = leaving.name();
  if (label) options["label"] = *label;
  write_octree(session, target, output, input, options);
  return kDone;
}

}  // namespace blackleaf::cli
