// The subcommands. Each declares its options on the session, parses, does its work and returns an exit code; whatever
// goes wrong is thrown.
#pragma once

#include "exit_codes.h"
#include "session.h"

namespace blackleaf::cli {

int run_build(Session& session);
int run_info(Session& session);
int run_translate(Session& session);
int run_move(Session& session);
int run_combine(Session& session);
int run_offset(Session& session);
int run_collide(Session& session);
int run_ray(Session& session);
int run_plan(Session& session);
int run_sweep(Session& session);
int run_animate(Session& session);
int run_draw(Session& session);
int run_export(Session& session);
int run_curve(Session& session);
int run_verify(Session& session);
int run_reproduce(Session& session);

}  // namespace blackleaf::cli
