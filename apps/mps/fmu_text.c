/* SPDX-License-Identifier: BSD-3-Clause */
/* Descriptions in an FMU: variables for importers, a page for users. */
#include "fmu.h"
#include "escape.h"
#include <mps/mps.h>
#include <string.h>

/* Units as powers of SI units. In 2-D a load is per metre of width. */
static const struct {
    const char *name;
    int dim, kg, m, s, rad; /* dim 0: both */
} units[] = {{"s", 0, 0, 0, 1, 0},       {"m", 0, 0, 1, 0, 0},      {"m/s", 0, 0, 1, -1, 0},
             {"m/s2", 0, 0, 1, -2, 0},   {"rad", 0, 0, 0, 0, 1},    {"rad/s", 0, 0, 0, -1, 1},
             {"rad/s2", 0, 0, 0, -2, 1}, {"N", 3, 1, 1, -2, 0},     {"N.m", 3, 1, 2, -2, 0},
             {"N/m", 2, 1, 0, -2, 0},    {"N.m/m", 2, 1, 1, -2, 0}, {"Pa", 0, 1, -1, -2, 0}};

static void put_text(FILE *out, const char *text)
{
    mps__put_escaped(out, text, mps__xml_character);
}

static void put_power(FILE *out, const char *name, int power)
{
    if (power) fprintf(out, " %s=\"%d\"", name, power);
}

/* Whether the unit of sensor v is in the table, or is that of a variable before number `index`. */
static bool is_known(const fmu_about *a, int32_t index, const fmu_variable *v)
{
    fmu_variable u;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strcmp(units[k].name, v->unit) == 0 && (!units[k].dim || units[k].dim == a->model.dim))
            return true;
    for (int32_t i = 0; i < index && fmu_variable_at(&a->model, i, &u); i++)
        if (u.kind == FMU_SENSOR && strcmp(u.unit, v->unit) == 0) return true;
    return v->unit[0] == '\0';
}

static void put_units(FILE *out, const fmu_about *a)
{
    fmu_variable v;
    fprintf(out, "  <UnitDefinitions>\n");
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        if (units[k].dim && units[k].dim != a->model.dim) continue;
        fprintf(out, "    <Unit name=\"%s\"><BaseUnit", units[k].name);
        put_power(out, "kg", units[k].kg);
        put_power(out, "m", units[k].m);
        put_power(out, "s", units[k].s);
        put_power(out, "rad", units[k].rad);
        fprintf(out, "/></Unit>\n");
    }
    for (int32_t i = 0; fmu_variable_at(&a->model, i, &v); i++) {
        if (v.kind != FMU_SENSOR || is_known(a, i, &v)) continue;
        fprintf(out, "    <Unit name=\"");
        put_text(out, v.unit);
        fprintf(out, "\"/>\n");
    }
    fprintf(out, "  </UnitDefinitions>\n");
}

static void put_variable(FILE *out, const fmu_about *a, const fmu_variable *v)
{
    const bool two = a->version == 2, time = v->kind == FMU_TIME;
    const char *causality = time ? "independent" : v->input ? "input" : "output";
    fprintf(out,
            "    <%s name=\"%s\" valueReference=\"%u\" causality=\"%s\" variability=\"continuous\"",
            two ? "ScalarVariable" : "Float64", v->name, (unsigned)v->reference, causality);
    if (!time && !v->input) fprintf(out, " initial=\"calculated\"");
    fprintf(out, " description=\"");
    put_text(out, v->about);
    fprintf(out, "\"%s", two ? "><Real" : "");
    if (v->unit[0]) {
        fprintf(out, " unit=\"");
        put_text(out, v->unit);
        fprintf(out, "\"");
    }
    fprintf(out, "%s/>%s\n", v->input ? " start=\"0\"" : "", two ? "</ScalarVariable>" : "");
}

/* Loads depend on all inputs; before the first step on none. */
static void put_outputs(FILE *out, const fmu_about *a, const char *name, const char *dependencies)
{
    fmu_variable v;
    for (int32_t i = 0; fmu_variable_at(&a->model, i, &v); i++) {
        if (v.input || v.kind == FMU_TIME) continue;
        fprintf(out, "    <%s %s=\"%u\"%s/>\n", name, a->version == 2 ? "index" : "valueReference",
                a->version == 2 ? (unsigned)i + 1 : (unsigned)v.reference, dependencies);
    }
}

static void put_structure(FILE *out, const fmu_about *a)
{
    fprintf(out, "  <ModelStructure>\n");
    if (a->version == 2) {
        fprintf(out, "    <Outputs>\n");
        put_outputs(out, a, "Unknown", "");
        fprintf(out, "    </Outputs>\n    <InitialUnknowns>\n");
        put_outputs(out, a, "Unknown", " dependencies=\"\"");
        fprintf(out, "    </InitialUnknowns>\n");
    } else {
        put_outputs(out, a, "Output", "");
        put_outputs(out, a, "InitialUnknown", " dependencies=\"\"");
    }
    fprintf(out, "  </ModelStructure>\n");
}

void fmu_write_description(FILE *out, const fmu_about *a)
{
    const bool two = a->version == 2;
    fmu_variable v;
    fprintf(out,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription "
            "fmiVersion=\"%s\" modelName=\"",
            two ? "2.0" : "3.0");
    put_text(out, a->name);
    fprintf(out,
            "\" description=\"A tank with liquid: pose in, load of the liquid out\"\n  "
            "generationTool=\"libmps %s\" variableNamingConvention=\"structured\" %s=\"%s\">\n",
            mps_version(NULL, NULL, NULL), two ? "guid" : "instantiationToken", a->token);
    fprintf(
        out,
        "  <CoSimulation modelIdentifier=\"%s\"\n    "
        "canHandleVariableCommunicationStepSize=\"true\" %s=\"true\" %s=\"true\" %s=\"true\"/>\n",
        a->identifier, two ? "canGetAndSetFMUstate" : "canGetAndSetFMUState",
        two ? "canSerializeFMUstate" : "canSerializeFMUState",
        two ? "providesDirectionalDerivative" : "providesDirectionalDerivatives");
    put_units(out, a);
    fprintf(out, "  <LogCategories>\n    <Category name=\"logAll\"/>\n    <Category "
                 "name=\"logStatusWarning\"/>\n    <Category name=\"logStatusDiscard\"/>\n    "
                 "<Category name=\"logStatusError\"/>\n  </LogCategories>\n  <ModelVariables>\n");
    for (int32_t i = 0; fmu_variable_at(&a->model, i, &v); i++) put_variable(out, a, &v);
    fprintf(out, "  </ModelVariables>\n");
    put_structure(out, a);
    fprintf(out, "</fmiModelDescription>\n");
}

void fmu_write_page(FILE *out, const fmu_about *a)
{
    fmu_variable v;
    fprintf(out, "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>");
    put_text(out, a->name);
    fprintf(out, "</title>\n<h1>");
    put_text(out, a->name);
    fprintf(
        out,
        "</h1>\n<p>A tank with liquid, by libmps %s. The importer says where the tank is at the "
        "end of the next step; the tank says what the liquid does to it, F = F0 - A a. "
        "Directional derivatives of force and moment by the accelerations are -A.%s</p>\n"
        "<table><tr><th>reference<th>name<th>unit<th>what\n",
        mps_version(NULL, NULL, NULL), a->model.dim == 2 ? " Loads are per metre of width." : "");
    for (int32_t i = 0; fmu_variable_at(&a->model, i, &v); i++) {
        fprintf(out, "<tr><td>%u<td>%s<td>", (unsigned)v.reference, v.name);
        put_text(out, v.unit);
        fprintf(out, "<td>");
        put_text(out, v.about);
        fprintf(out, "\n");
    }
    fprintf(out,
            "</table>\n<p>The case is resources/case.yaml. The file in binaries needs SUNDIALS, "
            "SuiteSparse, libyaml, cairo and zlib of the system.</p>\n<pre>");
    for (const char *line = fmu_licence; *line;) {
        const size_t length = strcspn(line, "\n");
        fprintf(out, "%.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
    fprintf(out, "</pre>\n</html>\n");
}
