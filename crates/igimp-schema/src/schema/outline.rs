//! Lines of polygons that stand in files.

use super::MANY;
use super::declare::table;

table! {
    OUTLINE: Outline,
    "Where the corners come from: a file, or the lines above and below, which run from one side of the ground to the other.";
    file: text, optional "`top` and `bottom` say it",
        "a CSV file with the columns x and y, or an ASCII DXF file; its path from the case file";
    drawing: part(DRAWING: Drawing);
    top: either(list(pair(length), 2, MANY), table(LINE_FILE: LineFile)), optional "`file` says it",
        "line above the body";
    bottom: either(list(pair(length), 2, MANY), table(LINE_FILE: LineFile)), optional "`file` says it",
        "line below the body";
}

table! {
    LINE_FILE: LineFile, "A line in a file.";
    file: text, required "\"rock.csv\"",
        "a CSV file with the columns x and y, or an ASCII DXF file; its path from the case file";
    drawing: part(DRAWING: Drawing);
}

table! {
    DRAWING: Drawing, "What tells of a file with a line.";
    layer: text, optional "the file is no drawing", "layer of the drawing that the line is on, alone";
    unit: text, optional "the header says it, as in `x [ft]`", "unit of length of the file";
}
