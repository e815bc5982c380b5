// cgal FILE [RUNS]: CGAL's Arrangement_2 with exact constructions, by the sweep over all segments.
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Traits = CGAL::Arr_segment_traits_2<Kernel>;
using Arrangement = CGAL::Arrangement_2<Traits>;
using Segment = Traits::X_monotone_curve_2;
using Pixel = std::pair<double, double>;

// Coordinates are whole numbers: steps of 1e-6 mm.
static std::vector<Segment> read(const char* file) {
    std::vector<Segment> segments;
    std::ifstream input(file);
    std::string line;
    while (std::getline(input, line)) {
        std::istringstream words(line);
        double x, y, u, v;
        words >> x >> y;
        while (words >> u >> v) {
            if (x != u || y != v) segments.emplace_back(Kernel::Point_2(x, y), Kernel::Point_2(u, v));
            x = u;
            y = v;
        }
    }
    return segments;
}

// The area inside the outer borders, mm2: that of all bounded faces. Relative to a vertex of each
// border, to lose no digits.
static double area(const Arrangement& arrangement) {
    double twice = 0.0;
    auto outside = arrangement.unbounded_face();
    for (auto hole = outside->holes_begin(); hole != outside->holes_end(); ++hole) {
        auto first = *hole, at = first;
        const double x0 = CGAL::to_double(first->source()->point().x());
        const double y0 = CGAL::to_double(first->source()->point().y());
        do {
            const auto &p = at->source()->point(), &q = at->target()->point();
            twice -= (CGAL::to_double(p.x()) - x0) * (CGAL::to_double(q.y()) - y0) -
                     (CGAL::to_double(q.x()) - x0) * (CGAL::to_double(p.y()) - y0);
            at = at->next();
        } while (at != first);
    }
    return twice * 0.5e-12;
}

// How many vertices are left when each is rounded to whole steps, half up.
static std::size_t pixels(const Arrangement& arrangement) {
    std::vector<Pixel> found;
    for (auto v = arrangement.vertices_begin(); v != arrangement.vertices_end(); ++v) {
        found.emplace_back(std::floor(CGAL::to_double(v->point().x()) + 0.5),
                           std::floor(CGAL::to_double(v->point().y()) + 0.5));
    }
    std::sort(found.begin(), found.end());
    return std::unique(found.begin(), found.end()) - found.begin();
}

static double peak() {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line)) {
        if (line.rfind("VmHWM:", 0) == 0) return std::atof(line.c_str() + 6) * 1024.0 / 1e6;
    }
    return 0.0;
}

int main(int count, char** words) {
    if (count < 2) return 2;
    const int runs = count > 2 ? std::atoi(words[2]) : 1;
    std::unique_ptr<Arrangement> arrangement;
    double least = INFINITY;
    for (int run = 0; run < runs; ++run) {
        // Read anew: the kernel keeps what it found out about its numbers.
        const std::vector<Segment> segments = read(words[1]);
        arrangement = std::make_unique<Arrangement>();
        const auto start = std::chrono::steady_clock::now();
        CGAL::insert(*arrangement, segments.begin(), segments.end());
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        least = std::min(least, time.count());
    }
    const double memory = peak();
    std::string name = words[1];
    name = name.substr(name.find_last_of('/') + 1);
    name = name.substr(0, name.find('.'));
    std::printf("%-22s %-12s %9.2f ms %6.0f MB %8zu V %8zu E %8zu F %.9f mm2\n",
                "CGAL " CGAL_VERSION_STR, name.c_str(), least * 1e3, memory,
                arrangement->number_of_vertices(), arrangement->number_of_edges(),
                arrangement->number_of_faces() - arrangement->number_of_unbounded_faces(),
                area(*arrangement));
    std::printf("%-22s %-12s %30zu V\n", "  rounded to 1e-6", name.c_str(), pixels(*arrangement));
}
