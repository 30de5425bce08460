#include "app/run_command.hpp"

namespace windlass::app {

void add_export(CommandLine& app, CommonOptions& common, int& status) {
  Command command = app.add_command("export", "rods for ParaView (VTK files .vtp and .pvd)");
  command.footer(
      "Open the .pvd file. It holds the centreline with directors, internal force, moment and pressure, the "
      "point\n"
      "forces (for the Glyph filter: scale by `force`), and the cylinder. Lengths are in units of rho, "
      "forces of\n"
      "EI/rho^2. A branch is a sequence in ParaView's time. A rod with a radius: Tube filter, Scalars "
      "`radius`, Vary\n"
      "Radius `By Absolute Scalar`. Forces between strands have `strand` = 1; `touched` is the place on "
      "the surface.\n"
      "Files go into RUN/vtk unless --out says otherwise.");
  const auto request = add_run(command, common, status, run_export);
  command
      .add("POINT", request->label,
           "a stored point, e.g. B1 or 2-17, or the number of a branch (default: every branch)")
      .type("");
  add_common_options(command, common);
}

}  // namespace windlass::app
