// Exhibits: the tables and figures that `reproduce` shows, on one page and as files of their own. To add one: write a
// function that returns an Exhibit and name it in kExhibits (cli/reproduce.cpp).
#pragma once

#include <string>
#include <vector>

#include "blackleaf/drawing_file.h"
#include "blackleaf/work.h"

namespace blackleaf::cli {

/// A file beside the page.
struct ExhibitFile {
  std::string name, content;  // content: bytes
};

/// A picture beside the page.
struct ExhibitDrawing {
  std::string name;
  LineDrawing drawing;
  PageOptions page;
};

/// A table of text: as HTML on the page, as CSV in a file.
struct Table {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many entries as columns

  std::string html() const;
  std::string csv() const;
};

struct Exhibit {
  std::string id;     // its anchor on the page, e.g. "wa87-table-1"
  std::string title;  // e.g. "WA87, Table 1: ..."
  std::string body;   // HTML: paragraphs, tables, inline SVG
  std::vector<ExhibitFile> files;
  std::vector<ExhibitDrawing> drawings;
};

/// WA87's Table 1: bounds on the nodes of a cube in any place, beside the most that random motions met.
Exhibit wa87_table_1(const Work& work);
/// WA87's Table 2: nodes of two objects before and after motions.
Exhibit wa87_table_2(const Work& work);
/// AN84's Figure 4: the nodes of an object before and after a translation.
Exhibit an84_figure_4(const Work& work);

/// AN84's Figure 2: an object, the division of its universe, its octree.
Exhibit an84_figure_2(const Work& work);
/// AN84's Figure 3: the octrees of a voxel before and after translations.
Exhibit an84_figure_3(const Work& work);
/// MHF92's Figure 1: the curves M_0, M_1 and M_2.
Exhibit mhf92_figure_1(const Work& work);
/// VA88's Figures 5 to 11: drawings of octrees made from silhouettes.
Exhibit va88_figure(int figure, const Work& work);
/// VA88's Figure 12: the time a drawing takes, measured, against the nodes of the octree.
Exhibit va88_figure_12(const Work& work);

/// The page of all exhibits: one HTML file that needs no other.
std::string html_page(const std::vector<Exhibit>& exhibits);

/// <p>text</p>, of HTML.
std::string paragraph(const std::string& html);

}  // namespace blackleaf::cli
