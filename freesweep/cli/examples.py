"""Examples at the end of each command's help: lines that can be run, by the name of the command."""

TUBE = '--alpha 30 --beta -30 --length "192 mm" --radius "4.76 mm" --wall "1.59 mm"'
HERE = '--alpha 25deg --beta -40deg --length "131 mm" --radius "5 mm"'
EXAMPLES = {
    "freesweep": (
        "freesweep sweep --example quick --map quick.png",
        f'freesweep inflate {TUBE} --material natural-latex --pressure 0 "15 psi" --steps 6',
        "freesweep --print-completion bash > ~/.local/share/bash-completion/completions/freesweep",
    ),
    "freesweep sweep": (
        "freesweep sweep --example quick --map quick.png",
        "freesweep sweep sweeps/design-space.toml -o atlases/design-space.nc --dry-run",
    ),
    "freesweep plot": ("freesweep plot map quick.nc", "freesweep plot curve quick.nc --variable rotation --each beta"),
    "freesweep plot map": (
        'freesweep plot map quick.nc --variable deformed_length --at "pressure=0.1 MPa" "length=150 mm"',
        "freesweep plot map quick.nc --over pressure",
        "freesweep plot map quick.nc --axes pressure alpha --at beta=-40",
    ),
    "freesweep plot validity": ('freesweep plot validity quick.nc --at "pressure=100 kPa"',),
    "freesweep plot curve": (
        "freesweep plot curve quick.nc --variable rotation --each beta --at alpha=10",
        "freesweep plot curve kept.nc --variable deformed_length",
    ),
    "freesweep plot shape": (
        f"freesweep plot shape {TUBE}",
        f'freesweep plot shape {TUBE} --material natural-latex --pressure 0 "0.2 MPa" --steps 31 -o turn.gif',
    ),
    "freesweep info": ("freesweep info quick.nc", "freesweep info quick.nc --specification > quick.toml"),
    "freesweep query": (
        f'freesweep query quick.nc {HERE} --pressure "15 psi" --refine',
        "freesweep query quick.nc --points designs.csv -o answers.csv",
    ),
    "freesweep export": (
        'freesweep export quick.nc -o slice.csv --variable rotation --at "length=100 mm" "radius=4.76 mm" beta=-40',
        "freesweep export curves.nc --to c --variable blocked_force --at design=muscle",
    ),
    "freesweep explore": ("freesweep explore quick.nc", "freesweep explore quick.nc --html explorer.html"),
    "freesweep lock": (f"freesweep lock {TUBE}",),
    "freesweep inflate": (
        f'freesweep inflate {TUBE} --material natural-latex --pressure 0 "15 psi" --steps 6 -o kept.nc',
        f"freesweep inflate {TUBE} --c10 0.11MPa --c01 0.06MPa --pressure 1bar --force 10N --json",
    ),
    "freesweep block": (
        f"freesweep block --hold length {TUBE} --material natural-latex --pressure 1bar",
        'freesweep block --hold rotation --alpha 0 --beta 30 --length "131 mm" --radius "4.76 mm" --wall "1.59 mm"'
        " --c10 0.17MPa --pressure 10kPa",
    ),
    "freesweep verify": ("freesweep verify quick.nc", "freesweep verify quick.nc --resolve 1000"),
    "freesweep bench": ("freesweep bench --quick",),
    "freesweep census": ("freesweep census 10000", "freesweep census 1000 --model physical --json"),
    "freesweep calibrate": (f"freesweep calibrate lengths.csv forces.csv {TUBE}",),
    "freesweep design": ("freesweep design sweeps/wishes/rotator.toml -o candidates.csv --picture candidates.png",),
    "freesweep thesis": ("freesweep thesis 2-7 claims", "freesweep thesis --out thesis"),
}
