// SPDX-License-Identifier: MIT
#include "methods/mapcleaner/mapcleaner.h"

namespace raymoval {
namespace mapcleaner_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kPublic = "the public program";
constexpr const char* kKitti = "the public program's settings for KITTI";

void add_terrain(Table& table) {
  table.number("terrain_cell", &P::terrain_cell, {"m", 0.05, 2, kKitti, "Side of a terrain cell."})
      .integer("terrain_points", &P::terrain_points,
               {"points", 1, 100000, "1 for KITTI, 3 in its other settings",
                "A cell with fewer ground points has no measured height."})
      .number("terrain_variance", &P::terrain_variance,
              {"m^2", 1e-6, 100, kPublic,
               "A cell with at least this variance of ground heights has no measured height."})
      .number("fill_radius", &P::fill_radius,
              {"m", 0, 5, kPublic,
               "Cells without a height are filled from cells with a height that are nearer than "
               "this; 0 fills none."})
      .number("fill_deviation", &P::fill_deviation,
              {"m", 0.001, 100, kPublic,
               "Standard deviation of the normal weight by which cells that deviate from the "
               "smooth ground around them count less.",
               "fill_radius > 0"})
      .integer(
          "fill_cells", &P::fill_cells,
          {"cells", 1, 10000, kPublic,
           "A cell with fewer such cells around it is not filled, here and in the second filling.",
           "fill_radius > 0 or refill_radius > 0"})
      .number("terrain_slope", &P::terrain_slope,
              {"deg", 0.1, 90, kPublic,
               "Terrain is the set of cells that can be reached from below the sensors through "
               "less steep cells; 90 is no limit."})
      .number("start_radius", &P::start_radius,
              {"m", 0, 50, "not in the public program",
               "If there is no terrain below a sensor, or it is too steep, the search begins at "
               "the nearest cells with terrain within this distance. If most of the ground within "
               "this distance is too steep, slopes are relative to its median slope. 0: no search "
               "begins there."})
      .number(
          "refill_radius", &P::refill_radius,
          {"m", 0, 5, kPublic, "The same as fill_radius, after unreachable cells were dropped."})
      .number("refill_deviation", &P::refill_deviation,
              {"m", 0.001, 100, kPublic, "The same as fill_deviation.", "refill_radius > 0"});
}

void add_split_and_votes(Table& table) {
  table
      .number("ground_height", &P::ground_height,
              {"m", 0, 10, kKitti,
               "Points within this height above or below the terrain are ground and kept."})
      .flag("remove_below", &P::remove_below,
            {.source = "the public program does not save them",
             .sentence = "Remove points farther below the terrain."})
      .number("voxel_size", &P::voxel_size,
              {"m", 0.05, 2, kPublic,
               "Edge of a voxel, whose points get one verdict, at their centroid."})
      .number("column_width", &P::column_width,
              {"deg", 0.08, 10, kKitti, "Width of a pixel of a scan's range image."})
      .number("row_height", &P::row_height, {"deg", 0.08, 10, kKitti, "Height of a pixel."})
      .number("vertical_view", &P::vertical_view,
              {"deg", 1, 180, kPublic,
               "Height of the images, half of it above the horizon. Points outside get no votes.",
               "public_field_of_view is true"})
      .integer("window_columns", &P::window_columns,
               {"pixels", 0, 20, kKitti,
                "A voxel is compared with this many columns to either side of its own."})
      .integer("window_rows", &P::window_rows,
               {"pixels", 0, 20, kKitti, "The same for rows, above and below."})
      .number("tolerance", &P::tolerance,
              {"m", 0.01, 10, kKitti,
               "A scan supports a voxel if a range in that window differs by at most this. It sees "
               "through the voxel if all ranges are larger."})
      .number("submap_radius", &P::submap_radius,
              {"m", 1, 500, kPublic, "Voxels within this distance of the sensor are compared."})
      .number("submap_travel", &P::submap_travel,
              {"m", 0, 500, kPublic,
               "These voxels are chosen again after the sensor moved farther than this."});
}

void add_switches(Table& table) {
  table
      .flag("public_field_of_view", &P::public_field_of_view,
            {.source = kPublic,
             .sentence = "Images go all around and have vertical_view. Else they have the sensor's "
                         "field of view."})
      .flag("public_overwrite", &P::public_overwrite,
            {.source = kPublic,
             .sentence = "A pixel has the range of the last point in it. Else it has the nearest."})
      .flag("public_steps", &P::public_steps,
            {.source = kPublic,
             .sentence = "Pixels and bins are set for the HDL-64E of KITTI. Else pixels are "
                         "enlarged until the window covers the angular steps of the sensor, and "
                         "bin_points and lowest_points are reduced in proportion to its angular "
                         "spacing, to at least three."});
}

Table make_table() {
  Table table;
  patchwork::add_ground_parameters(table);
  add_terrain(table);
  add_split_and_votes(table);
  add_switches(table);
  return table;
}

}  // namespace
}  // namespace mapcleaner_method

namespace {

std::vector<std::string> mapcleaner_notes() {
  return {
      "The default is the public program set for KITTI, whose ground segmentation is "
      "Patchwork++ instead of the paper's; its quirks have switches (public_...).",
      "Points voted dynamic are dynamic. The public program does not save points below the "
      "terrain, so they are removed (remove_below); it saves points without terrain in a separate "
      "file as neither static nor dynamic, so they are kept.",
      "Scans are not thinned before they are added to the map; the public program can do this.",
      "Voxels and terrain cells are those of the lattice at the world's origin.",
      "Patchwork++: variances are those of the sample; where only one plane is known, its "
      "deviation is 0; where no plane of a ring is low enough, none is accepted for similarity; a "
      "bin all of whose points lie below 1.2 sensor heights begins with all of them.",
      "Filling: a cell at the distance of the radius does not count; one with too few others "
      "around it to have a smooth height does not count in the second round.",
      "A cell without neighbours along an axis is level along it.",
      "A scan without points has no votes, and no terrain search begins and no voxels are chosen "
      "below it.",
      "sound begins the terrain at the cells nearest to a sensor that has none below it, up to "
      "12.4 m away, where the innermost zone of Patchwork++ ends: else a stationary sensor has no "
      "terrain. Where all ground within that distance is too steep, slopes are relative to its "
      "median slope, so that a hill has a terrain.",
      "sound has pixels so large that the window around a voxel reaches from one beam to the next, "
      "and requires fewer points in a bin where the sensor's directions are farther apart than "
      "those of the HDL-64E.",
      "Filling: however far a cell deviates, it counts at least exp(-60).",
      "sound has images a pixel larger on each side than the sensor's field of view.",
      "sound estimates the sensor's height by the median of the upright planes that its first scan "
      "with ground has in the innermost zone.",
      "Pixels of points and of voxels are found in single precision, and the terrain is filled "
      "in it, relative to a height nearby.",
  };
}

}  // namespace

MethodEntry mapcleaner_entry() {
  const Configuration sound = {{"public_height", false},        {"public_axes", false},
                               {"public_field_of_view", false}, {"public_overwrite", false},
                               {"public_steps", false},         {"remove_below", false},
                               {"start_radius", 12.4}};
  MethodEntry entry;
  entry.name = "mapcleaner";
  entry.version = "2";
  entry.sentence =
      "Fits a terrain to the ground points of all scans; removes points above it that more scans "
      "see through than support.";
  entry.source =
      "MapCleaner: Efficiently Removing Moving Objects from Point Cloud Maps in Autonomous Driving "
      "Scenarios (Remote Sensing 2022), ground by Patchwork++ (IROS 2022)";
  entry.bibtex = R"(@article{fu2022mapcleaner,
  author = {Fu, Hao and Xue, Hanzhang and Xie, Guanglei},
  title = {{MapCleaner}: Efficiently Removing Moving Objects from Point Cloud Maps in Autonomous
    Driving Scenarios},
  journal = {Remote Sensing},
  year = {2022},
  volume = {14},
  number = {18},
  pages = {4496},
  doi = {10.3390/rs14184496}
}
)";
  entry.notes = mapcleaner_notes();
  entry.variants = {
      {.name = "published", .sentence = "As the public program is set for KITTI."},
      {.name = "sound",
       .sentence = "Without the quirks of the public program: height, axes and field of view are "
                   "the sensor's.",
       .overrides = sound,
       .developed_on = "KITTI raw drive 0005"},
  };
  entry.bind(mapcleaner_method::make_table(), mapcleaner_method::make_mapcleaner);
  return entry;
}

}  // namespace raymoval
