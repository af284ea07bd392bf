/* SPDX-License-Identifier: BSD-3-Clause */
/* A state for ParaView. It is a script, not a .pvsm: a .pvsm contains absolute file names and some
 * thousand properties that change between versions. */
#include "picture_scene.h"
#include "run_file.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char head[] =
    "# State for ParaView 5.10 or newer: File > Load State, or  paraview --state=paraview.py\n"
    "import os\n"
    "import paraview\n"
    "from paraview.simple import *\n"
    "\n"
    "try:\n"
    "    folder = os.path.dirname(os.path.abspath(__file__))\n"
    "except NameError:  # ParaView may run this text without a name\n"
    "    folder = os.getcwd()\n"
    "if not os.path.exists(os.path.join(folder, 'frames.pvd')):\n"
    "    folder = written_to\n"
    "\n"
    "paraview.simple._DisableFirstRenderCameraReset()\n"
    "frames = PVDReader(registrationName='frames', FileName=os.path.join(folder, 'frames.pvd'))\n"
    "scene = GetAnimationScene()\n"
    "scene.UpdateAnimationUsingDataTimeSteps()\n"
    "view = GetActiveViewOrCreate('RenderView')\n"
    "view.UseColorPaletteForBackground = 0\n"
    "view.Background = [1, 1, 1]\n"
    "view.OrientationAxesLabelColor = [0, 0, 0]\n"
    "\n"
    "\n"
    "def only(source, array, value, name):\n"
    "    \"\"\"The particles of `source` with this value.\"\"\"\n"
    "    kept = Threshold(registrationName=name, Input=source)\n"
    "    kept.Scalars = ['POINTS', array]\n"
    "    kept.ThresholdMethod = 'Between'\n"
    "    kept.LowerThreshold = value - 0.5\n"
    "    kept.UpperThreshold = value + 0.5\n"
    "    return kept\n"
    "\n"
    "\n"
    "def spheres(source, radius):\n"
    "    shown = Show(source, view)\n"
    "    shown.SetRepresentationType('Point Gaussian')\n"
    "    shown.GaussianRadius = radius\n"
    "    shown.ShaderPreset = 'Plain circle' if flat else 'Sphere'\n"
    "    return shown\n"
    "\n"
    "\n"
    "walls = only(frames, 'kind', 1, 'walls')\n"
    "shown = spheres(walls, dp / 2 if flat else dp / 4)\n"
    "shown.ColorArrayName = [None, '']\n"
    "shown.AmbientColor = shown.DiffuseColor = [0.60, 0.62, 0.65]\n"
    "shown.Opacity = 1.0 if flat else 0.15\n"
    "\n"
    "fluid = only(frames, 'kind', 0, 'fluid')\n"
    "for phase, (label, colours) in enumerate(phases):\n"
    "    part = only(fluid, 'phase', phase, label)\n"
    "    shown = spheres(part, dp / 2)\n"
    "    ColorBy(shown, ('POINTS', 'pressure'), separate=True)\n"
    "    table = GetColorTransferFunction('pressure', shown, separate=True)\n"
    "    table.AutomaticRescaleRangeMode = 'Never'\n"
    "    table.ColorSpace = 'RGB'\n"
    "    table.RGBPoints = [number for k, colour in enumerate(colours)\n"
    "                       for number in (scale[0] + (scale[1] - scale[0]) * k / (len(colours) - "
    "1), *colour)]\n"
    "    bar = GetScalarBar(table, view)\n"
    "    bar.Title = 'pressure [Pa]' if len(phases) == 1 else 'pressure [Pa], ' + label\n"
    "    bar.ComponentTitle = ''\n"
    "    bar.TitleColor = bar.LabelColor = [0.13, 0.15, 0.18]\n"
    "    bar.TitleFontSize = bar.LabelFontSize = 13\n"
    "    bar.AutomaticLabelFormat = 0\n"
    "    bar.LabelFormat = bar.RangeLabelFormat = '%.4g'\n"
    "    bar.WindowLocation = 'Any Location'\n"
    "    bar.Position = [0.90 - 0.10 * phase, 0.30]\n"
    "    bar.ScalarBarLength = 0.4\n"
    "    bar.Visibility = 1\n"
    "\n"
    "clock = AnnotateTimeFilter(registrationName='time', Input=frames)\n"
    "clock.Format = 't = {time:.3f} s'\n"
    "shown = Show(clock, view)\n"
    "shown.Color = [0.13, 0.15, 0.18]\n"
    "shown.FontSize = 14\n"
    "Hide(frames, view)\n"
    "\n"
    "# ---- camera\n"
    "middle = [(a + b) / 2 for a, b in zip(lo, hi)]\n"
    "size = max(b - a for a, b in zip(lo, hi))\n"
    "towards = [0, 0, 1] if flat else [0.46, 0.37, 0.80]\n"
    "view.InteractionMode = '2D' if flat else '3D'\n"
    "view.CameraParallelProjection = 1\n"
    "view.CameraFocalPoint = middle\n"
    "view.CameraPosition = [m + 4 * size * d for m, d in zip(middle, towards)]\n"
    "view.CameraViewUp = [0, 1, 0]\n"
    "view.CameraParallelScale = dp + 0.6 * max(hi[1] - lo[1], (hi[0] - lo[0]) * (0.6 if flat else "
    "0.75))\n"
    "scene.GoToLast()\n"
    "Render()\n";

/* Write a Python string in single quotes. */
static void print_text(FILE *file, const char *text)
{
    fputc('\'', file);
    for (; *text; text++) {
        if (*text == '\'' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else if ((unsigned char)*text < 0x20)
            fprintf(file, "\\x%02x", (unsigned)(unsigned char)*text);
        else
            fputc(*text, file);
    }
    fputc('\'', file);
}

static void print_number(FILE *file, double value, const char *end)
{
    fprintf(file, "%.9g%s", value, end);
}

static void print_vector(FILE *file, const char *name, const double *x, int count)
{
    if (name) fprintf(file, "%s = ", name);
    fputc('[', file);
    for (int d = 0; d < count; d++) print_number(file, x[d], d + 1 < count ? ", " : "]");
    if (name) fputc('\n', file);
}

static void print_phases(FILE *file, const scene *s)
{
    fputs("phases = [\n", file);
    for (int32_t k = 0; k < (s->phases > 1 ? s->phases : 1); k++) {
        const double(*map)[3] = mps__scale_map[k % SCALE_MAPS];
        fprintf(file, "    ('phase %d', [", (int)k);
        for (int c = 0; c < SCALE_COLOURS; c++) {
            print_vector(file, NULL, map[c], 3);
            fputs(c + 1 < SCALE_COLOURS ? ", " : "]),\n", file);
        }
    }
    fputs("]\n\n", file);
}

/* The values of the run come first, after the encoding that Python reads in the first two lines. */
static void print_script(FILE *file, const scene *s, const char *folder)
{
    const double scale[2] = {s->p_lo, s->p_hi};
    fputs("# -*- coding: utf-8 -*-\n", file);
    fputs("written_to = ", file);
    print_text(file, folder);
    fputs("\ndp = ", file);
    print_number(file, s->dp, "  # [m]\n");
    fprintf(file, "flat = %s  # 2-D\n", s->dim == 2 ? "True" : "False");
    print_vector(file, "lo", s->lo, 3);
    print_vector(file, "hi", s->hi, 3);
    print_vector(file, "scale", scale, 2);
    print_phases(file, s);
    fputs(head, file);
}

/* The absolute name of a folder; NULL: memory is exhausted, or the name is too long. */
static char *whole_path(const char *folder)
{
    enum { PATH_SIZE = 4096 };
    char here[PATH_SIZE];
    if (folder[0] == '/') return mps__page_path(folder, "");
    return getcwd(here, sizeof here) ? mps__page_path(here, folder) : NULL;
}

static mps_status write_script(const scene *s, const char *folder, page_errors *e)
{
    char *path = mps__page_path(folder, "paraview.py"), *whole = whole_path(folder);
    FILE *file = path && whole ? mps__run_create(path, "w") : NULL;
    mps_status status = MPS_OK;
    if (file) print_script(file, s, whole);
    bool failed = !file || ferror(file);
    if (file && fclose(file) != 0) failed = true;
    if (!path || !whole)
        status = mps__page_fail(e, MPS_E_NOMEM, "no memory for paraview.py");
    else if (failed)
        status = mps__page_fail(e, MPS_E_IO, "cannot write '%s': %s", path, strerror(errno));
    if (file && failed) remove(path);
    free(whole);
    free(path);
    return status;
}

/* Transform the box of the scene from the frame of the tank to that of the frames, over all of
 * them: the camera covers the whole motion. */
static void sweep_box(scene *s, const film *f)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t k = 0; k < f->run->frames; k++)
        for (int corner = 0; corner < 8; corner++) {
            double X[3];
            for (int d = 0; d < 3; d++) X[d] = corner >> d & 1 ? s->hi[d] : s->lo[d];
            for (int d = 0; d < 3; d++) {
                const double *row = f->pose[k].turn + 3 * d;
                const double x = row[0] * X[0] + row[1] * X[1] + row[2] * X[2] +
                                 f->pose[k].shift[d];
                lo[d] = fmin(lo[d], x);
                hi[d] = fmax(hi[d], x);
            }
        }
    memcpy(s->lo, lo, sizeof lo);
    memcpy(s->hi, hi, sizeof hi);
}

/* The last frame as a scene, for its walls and phases. */
static mps_status describe(scene *s, const film *f, page_errors *e)
{
    film_frame frame = {0};
    const int64_t last = f->run->frames - 1;
    mps_status status = mps__scene_of_run(s, f);
    if (status == MPS_OK) status = mps__film_frame_read(f, last, &frame);
    if (status == MPS_OK) status = mps__scene_of_frame(s, f, last, &frame);
    mps__film_frame_free(&frame);
    if (status == MPS_OK && !mps__scene_end(s))
        status = mps__page_fail(e, MPS_E_ARG, "no paraview.py: a frame has no particle");
    if (status == MPS_OK) sweep_box(s, f);
    s->p_lo = f->pressure.lo;
    s->p_hi = f->pressure.hi;
    return status;
}

mps_status mps_paraview_save(const char *folder, char *error, size_t error_size)
{
    page_errors e = {error, error_size};
    page_run run = {0};
    film f = {0};
    scene s = {0};
    if (error && error_size > 0) error[0] = '\0';
    if (!folder || !folder[0]) return mps__page_fail(&e, MPS_E_ARG, "paraview.py has no folder");
    mps_status status = mps__page_run_read(&run, folder, &e);
    if (status == MPS_OK && run.frames == 0)
        status = mps__page_fail(&e, MPS_E_ARG, "no paraview.py: the folder '%s' has no frame",
                                folder);
    if (status == MPS_OK) status = mps__film_survey(&f, &run);
    if (status == MPS_OK) status = describe(&s, &f, &e);
    if (status == MPS_OK) status = write_script(&s, folder, &e);
    mps__scene_free(&s);
    mps__film_free(&f);
    mps__page_run_free(&run);
    return status;
}
