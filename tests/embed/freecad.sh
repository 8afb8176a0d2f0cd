# freecad.sh SCRIPT: runs it in FreeCAD; 77 where that is not installed. FreeCAD's own status says nothing, its output does.
command -v freecadcmd >/dev/null || { echo "skipped: freecadcmd is not installed (Debian: freecad)"; exit 77; }
HOME=$(mktemp -d)
export HOME
said=$(freecadcmd "$1" 2>&1)
echo "$said"
rm -rf "$HOME"
case "$said" in *"freecad: fine"*) ;; *) exit 1 ;; esac
