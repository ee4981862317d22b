var e=[`empty`,`ceiling`,`floor`,`wall`,`window`,`chair`,`bed`,`sofa`,`table`,`television`,`furniture`,`object`],t=[{name:`ceiling`,title:`ceiling`,class_id:1,labels:[`ceiling tile`]},{name:`floor`,title:`floor`,class_id:2,labels:[`floor wood`,`floor tile`,`floor marble`,`floor stone`,`flooring`]},{name:`wall`,title:`wall`,class_id:3,labels:[`wall brick`,`wall stone`,`wall tile`,`wall wood`,`wall panel`,`wall concrete`]},{name:`window`,title:`window`,class_id:4,labels:[`windowpane`]},{name:`rug`,title:`rug`,class_id:2,labels:[`carpet`,`mat`,`floor mat`,`doormat`]},{name:`chair`,title:`chair`,class_id:5,labels:[`seat`,`folding chair`,`dining chair`]},{name:`armchair`,title:`armchair`,class_id:5,labels:[`recliner`,`easy chair`,`club chair`]},{name:`office chair`,title:`office chair`,class_id:5,labels:[`swivel chair`,`desk chair`]},{name:`beanbag`,title:`beanbag`,class_id:5,labels:[`bean bag`]},{name:`stool`,title:`stool`,class_id:5,labels:[`footstool`]},{name:`bar stool`,title:`bar stool`,class_id:5,labels:[`barstool`,`high stool`]},{name:`bench`,title:`bench`,class_id:5,labels:[`window seat`]},{name:`ottoman`,title:`ottoman`,class_id:5,labels:[`pouf`,`pouffe`,`hassock`]},{name:`sofa`,title:`sofa`,class_id:7,labels:[`couch`,`settee`,`loveseat`,`sofa bed`,`studio couch`]},{name:`corner sofa`,title:`corner sofa`,class_id:7,labels:[`sectional`,`sectional sofa`,`l shaped sofa`]},{name:`bed`,title:`bed`,class_id:6,labels:[`infant bed`]},{name:`single bed`,title:`single bed`,class_id:6,labels:[`twin bed`,`daybed`]},{name:`bunk bed`,title:`bunk bed`,class_id:6,labels:[`loft bed`]},{name:`crib`,title:`crib`,class_id:6,labels:[`cradle`,`cot`]},{name:`table`,title:`table`,class_id:8,labels:[`dining table`,`kitchen table`,`play table`,`kitchen & dining room table`]},{name:`round table`,title:`round table`,class_id:8,labels:[]},{name:`bar table`,title:`bar table`,class_id:8,labels:[`high table`,`bistro table`]},{name:`coffee table`,title:`coffee table`,class_id:8,labels:[`low table`,`cocktail table`]},{name:`side table`,title:`side table`,class_id:8,labels:[`end table`,`occasional table`]},{name:`console table`,title:`console table`,class_id:8,labels:[`sofa table`,`hall table`]},{name:`desk`,title:`desk`,class_id:8,labels:[`writing desk`,`computer desk`]},{name:`picnic table`,title:`picnic table`,class_id:8,labels:[]},{name:`pool table`,title:`pool table`,class_id:8,labels:[`billiard table`,`snooker table`]},{name:`table tennis table`,title:`table tennis table`,class_id:8,labels:[`ping pong table`]},{name:`cabinet`,title:`cabinet`,class_id:10,labels:[`cupboard`,`case`,`storage`,`filing cabinet`,`locker`,`bathroom cabinet`,`bath cabinet`,`cabinetry`]},{name:`wall cabinet`,title:`wall cabinet`,class_id:10,labels:[`upper cabinet`,`hanging cabinet`]},{name:`display cabinet`,title:`display cabinet`,class_id:10,labels:[`vitrine`,`glass cabinet`,`china cabinet`]},{name:`wardrobe`,title:`wardrobe`,class_id:10,labels:[`closet`,`armoire`]},{name:`chest of drawers`,title:`chest of drawers`,class_id:10,labels:[`dresser`,`drawer`,`bureau`,`commode`,`tallboy`]},{name:`sideboard`,title:`sideboard`,class_id:10,labels:[`buffet`,`credenza`]},{name:`tv stand`,title:`tv stand`,class_id:10,labels:[`tv board`,`tv cabinet`,`media console`,`entertainment center`]},{name:`nightstand`,title:`nightstand`,class_id:10,labels:[`night stand`,`bedside table`,`bedside cabinet`]},{name:`blanket chest`,title:`blanket chest`,class_id:10,labels:[`trunk`,`chest`]},{name:`bookcase`,title:`bookcase`,class_id:10,labels:[`bookshelf`]},{name:`shelf`,title:`shelf`,class_id:10,labels:[`shelves`,`shelving`,`rack`,`shelf unit`,`spiral shelf`,`toy shelf`]},{name:`wall shelf`,title:`wall shelf`,class_id:10,labels:[`floating shelf`]},{name:`shoe rack`,title:`shoe rack`,class_id:10,labels:[`shoe cabinet`]},{name:`furniture`,title:`piece of furniture`,class_id:10,labels:[`otherfurniture`,`other furniture`]},{name:`counter`,title:`counter`,class_id:10,labels:[`countertop`,`bar`,`worktop`,`kitchen counter`,`base cabinet`]},{name:`kitchen island`,title:`kitchen island`,class_id:10,labels:[`island`]},{name:`sink`,title:`sink`,class_id:10,labels:[`kitchen sink`,`sink unit`,`sink counter`]},{name:`oven`,title:`oven`,class_id:10,labels:[`wall oven`,`built in oven`]},{name:`stove`,title:`stove`,class_id:10,labels:[`cooker`,`range`,`hob`,`gas stove`,`cooktop`]},{name:`range hood`,title:`range hood`,class_id:11,labels:[`hood`,`extractor hood`,`cooker hood`]},{name:`refrigerator`,title:`refrigerator`,class_id:10,labels:[`fridge`,`freezer`]},{name:`dishwasher`,title:`dishwasher`,class_id:10,labels:[]},{name:`washing machine`,title:`washing machine`,class_id:10,labels:[`washer`,`washer dryer`,`clothes dryer`,`dryer`,`tumble dryer`]},{name:`microwave`,title:`microwave`,class_id:11,labels:[`microwave oven`,`toaster`,`toaster oven`]},{name:`toilet`,title:`toilet`,class_id:11,labels:[`water closet`,`wc`,`bidet`]},{name:`washbasin`,title:`washbasin`,class_id:10,labels:[`basin`,`bathroom sink`,`pedestal sink`,`vanity`,`washstand`]},{name:`bathtub`,title:`bathtub`,class_id:10,labels:[`bath`,`tub`,`jacuzzi`]},{name:`shower`,title:`shower`,class_id:11,labels:[`shower cabin`,`shower stall`]},{name:`shower curtain`,title:`shower curtain`,class_id:11,labels:[]},{name:`towel`,title:`towel`,class_id:11,labels:[`bath towel`]},{name:`laundry basket`,title:`laundry basket`,class_id:11,labels:[`basket`,`hamper`,`laundry hamper`]},{name:`drying rack`,title:`drying rack`,class_id:11,labels:[`clothes horse`,`clothes airer`,`airer`]},{name:`ironing board`,title:`ironing board`,class_id:11,labels:[`iron`]},{name:`television`,title:`screen`,class_id:9,labels:[`tv`,`television receiver`,`crt screen`,`screen`]},{name:`monitor`,title:`monitor`,class_id:9,labels:[`computer`,`computer monitor`,`computer screen`,`display`]},{name:`projector screen`,title:`projector screen`,class_id:9,labels:[`projection screen`]},{name:`door`,title:`door`,class_id:11,labels:[`double door`,`screen door`,`door handle`]},{name:`curtain`,title:`curtain`,class_id:11,labels:[`drape`,`drapery`,`drapes`]},{name:`blind`,title:`blind`,class_id:11,labels:[`blinds`,`window blind`,`roller blind`,`venetian blind`,`shade`]},{name:`picture`,title:`picture`,class_id:11,labels:[`painting`,`poster`,`picture frame`,`portrait`,`photo`]},{name:`mirror`,title:`mirror`,class_id:11,labels:[]},{name:`whiteboard`,title:`whiteboard`,class_id:11,labels:[`bulletin board`,`blackboard`,`notice board`]},{name:`clock`,title:`clock`,class_id:11,labels:[`wall clock`,`alarm clock`]},{name:`grandfather clock`,title:`grandfather clock`,class_id:10,labels:[`longcase clock`]},{name:`radiator`,title:`radiator`,class_id:11,labels:[`heater`,`heating`]},{name:`towel radiator`,title:`towel radiator`,class_id:11,labels:[`towel rail`,`heated towel rail`]},{name:`fireplace`,title:`fireplace`,class_id:10,labels:[`hearth`]},{name:`lamp`,title:`lamp`,class_id:11,labels:[`floor lamp`,`standing lamp`,`arc lamp`]},{name:`table lamp`,title:`table lamp`,class_id:11,labels:[`desk lamp`,`bedside lamp`]},{name:`ceiling lamp`,title:`ceiling lamp`,class_id:11,labels:[`light`,`ceiling light`,`light fixture`]},{name:`pendant lamp`,title:`pendant lamp`,class_id:11,labels:[`pendant`,`hanging lamp`,`pendant light`]},{name:`chandelier`,title:`chandelier`,class_id:11,labels:[]},{name:`wall lamp`,title:`wall lamp`,class_id:11,labels:[`sconce`,`wall light`]},{name:`candle`,title:`candle`,class_id:11,labels:[`candles`,`candlestick`]},{name:`plant`,title:`plant`,class_id:11,labels:[`potted plant`,`houseplant`,`flowerpot`]},{name:`indoor tree`,title:`indoor tree`,class_id:11,labels:[`potted tree`]},{name:`flowers`,title:`flowers`,class_id:11,labels:[`flower`,`bouquet`]},{name:`cactus`,title:`cactus`,class_id:11,labels:[]},{name:`hanging plant`,title:`hanging plant`,class_id:11,labels:[]},{name:`planter`,title:`planter`,class_id:11,labels:[`planter box`,`plant box`]},{name:`christmas tree`,title:`christmas tree`,class_id:11,labels:[`fir tree`]},{name:`piano`,title:`piano`,class_id:10,labels:[`upright piano`]},{name:`grand piano`,title:`grand piano`,class_id:10,labels:[]},{name:`aquarium`,title:`aquarium`,class_id:11,labels:[`fish tank`,`tank`]},{name:`bicycle`,title:`bicycle`,class_id:11,labels:[`bike`]},{name:`toy`,title:`toy`,class_id:11,labels:[`plaything`,`teddy`,`teddy bear`,`doll`,`bricks`,`rocking horse`,`arcade machine`]},{name:`ball`,title:`ball`,class_id:11,labels:[`sports ball`,`gym ball`]},{name:`guitar`,title:`guitar`,class_id:11,labels:[`musical instrument`]},{name:`easel`,title:`easel`,class_id:11,labels:[]},{name:`cat tree`,title:`cat tree`,class_id:11,labels:[`scratching post`]},{name:`box`,title:`box`,class_id:11,labels:[`cardboard`,`carton`,`barrel`,`cardboard box`]},{name:`crate`,title:`crate`,class_id:11,labels:[`wooden crate`]},{name:`bag`,title:`bag`,class_id:11,labels:[`backpack`,`handbag`,`suitcase`,`luggage`]},{name:`waste bin`,title:`waste bin`,class_id:11,labels:[`ashcan`,`trash can`,`garbage bin`,`waste container`,`trash bin`,`pedal bin`,`bin`]},{name:`coat stand`,title:`coat stand`,class_id:11,labels:[`coat rack`,`hat stand`]},{name:`umbrella stand`,title:`umbrella stand`,class_id:11,labels:[]},{name:`vase`,title:`vase`,class_id:11,labels:[`pot`,`urn`,`floor vase`]},{name:`sculpture`,title:`sculpture`,class_id:11,labels:[`bust`,`statue`]},{name:`cushion`,title:`cushion`,class_id:11,labels:[`pillow`]},{name:`blanket`,title:`blanket`,class_id:11,labels:[`quilt`,`bedspread`,`duvet`]},{name:`books`,title:`books`,class_id:11,labels:[`book`,`magazine`]},{name:`paper`,title:`paper`,class_id:11,labels:[`document`,`newspaper`]},{name:`clothes`,title:`clothes`,class_id:11,labels:[`apparel`,`clothing`,`laundry`,`coat`,`coats`,`tie`,`umbrella`,`hat`]},{name:`shoes`,title:`shoes`,class_id:11,labels:[`shoe`,`boots`,`slippers`]},{name:`laptop`,title:`laptop`,class_id:11,labels:[`notebook computer`]},{name:`printer`,title:`printer`,class_id:11,labels:[`copier`,`scanner`]},{name:`keyboard`,title:`keyboard`,class_id:11,labels:[`computer keyboard`,`mouse`,`remote`,`cell phone`]},{name:`tableware`,title:`tableware`,class_id:11,labels:[`plate`,`bottle`,`glass`,`wine glass`,`cup`,`fork`,`knife`,`spoon`,`bowl`,`tray`,`kettle`]},{name:`food`,title:`food`,class_id:11,labels:[`fruit`,`banana`,`apple`,`sandwich`,`orange`,`broccoli`,`carrot`,`hot dog`,`pizza`,`donut`,`cake`]},{name:`fan`,title:`fan`,class_id:11,labels:[`ceiling fan`,`ventilator`]},{name:`person`,title:`person`,class_id:11,labels:[`man`,`woman`,`people`]},{name:`animal`,title:`animal`,class_id:11,labels:[`cat`,`dog`]},{name:`stairs`,title:`stairs`,class_id:11,labels:[`stairway`,`step`,`case of stairs`,`staircase`,`escalator`]},{name:`railing`,title:`railing`,class_id:11,labels:[`bannister`,`banister`,`handrail`]},{name:`column`,title:`column`,class_id:11,labels:[`pole`,`pillar`,`other structure`,`otherstructure`]},{name:`object`,title:`object`,class_id:11,labels:[`otherprop`,`other prop`,`base`,`signboard`,`booth`,`stage`,`canopy`,`flag`,`trade name`,`conveyer belt`,`banner`,`net`,`platform`,`skateboard`,`tennis racket`,`scissors`,`hair drier`,`toothbrush`,`baseball bat`,`baseball glove`,`frisbee`,`skis`,`snowboard`,`surfboard`,`kite`]}],n={compass:[`Right`,`Back`,`Top`,`Left`,`Front`,`Bottom`],start:{title:`Turn a room into Minecraft`,lead:`Everything runs on this computer. Nothing is uploaded to the internet.`,drop:`Drop a capture here`,dropHint:`A folder, a video or a ZIP file`,dropNow:`Release to upload`,chooseFiles:`Choose files…`,chooseFolder:`Choose folder…`,limit:e=>`Up to ${e}`,works:`What works`,kindsOfCapture:[[`photo`,`Photos`,`30 to 100, taken while you walk around the room`],[`video`,`Video`,`one to three minutes, filmed slowly`],[`scan`,`Scanner app`,`exports of Polycam, Record3D, Scaniverse, Stray Scanner and others`],[`frames`,`RGB-D frames`,`colour and depth with poses, as in ScanNet or TUM`],[`cube`,`3D model`,`a mesh or point cloud: .glb, .ply, .obj`],[`plan`,`Floor plan`,`RoomPlan as .json or .usdz`]],phone:{title:`Scan with a phone`,lead:`Point its camera at the code. Phone and computer are in the same Wi-Fi.`,alt:`QR code with a link for the phone`,left:e=>`valid for ${e}`,renew:`New code`,old:`The code is too old.`,connected:e=>`${e} ${e===1?`phone is`:`phones are`} connected. What it sends appears under Your rooms.`,off:[`Your phone`,`start with w2m forge --phone to scan a room over Wi-Fi`]},untitled:(e,t)=>`${t} ${e}`,countOf:e=>`${e} ${e===1?`file`:`files`}`,rooms:`Your rooms`,example:`Open the example room`,exampleLead:`A finished living room to edit and walk in`,demo:`Make a room up`,demoLead:`Generates a furnished room, scans it with a virtual camera and rebuilds it.`,kinds:{living:`Living room`,bed:`Bedroom`,kitchen:`Kitchen`,dining:`Dining room`,study:`Study`},states:{room:`Ready`,working:`Running`,ready:`Not started`,partly:`Incomplete`,here:`Opened`},finished:{title:`Finished room`,alt:e=>`${e} as blocks`,edit:`Open in the editor`,report:`See the report`,share:`Send to a friend`,sharing:`Writing one file that opens in any browser…`,shared:(e,t)=>`${e}, ${t}: send it, it opens in any browser`,install:`Install in Minecraft`},start:`Create room`,again:`Create room again`,back:`Back`,cancel:`Cancel`,remove:`Delete`,removeConfirm:`Delete capture and room?`,sending:(e,t)=>`${e} of ${t}`,sendingTitle:`Uploading capture`,live:`The room so far`,layers:{cameras:`Cameras`,points:`Points`,cells:`Cells`,things:`Things`,blocks:`Blocks`},looking:`Inspecting capture`,making:`Creating room`,found:`Capture summary`,choices:`Build options`,size:`Size in the game`,sizeNames:{1:`Life size`,2:`Double`,4:`Large`,"12.5":`Giant`},sizes:{1:`1 block per metre. You fit through the doors; furniture is simplified.`,2:`2 blocks per metre, as players usually build rooms.`,4:`4 blocks per metre. All furniture is recognisable.`,"12.5":`12.5 blocks per metre: one block for each 8 cm of the scan.`},style:`Furniture`,styles:{blocks:`Blocks`,display:`Fine details`,voxels:`As scanned`},styleHints:{blocks:`Furniture made of regular blocks, which players can change.`,display:`Fine shapes; needs Minecraft 1.19.4 or later.`,voxels:`Each object as it was scanned, without furniture designs.`},known:`Known length`,knownNone:`None`,knownHint:`Photos have no absolute scale. Enter a length you know to set it.`,knownMetres:`Length in metres`,why:{stop:`This capture cannot be reconstructed; see the capture summary`,working:`A job is running for this capture`,notWhole:`The upload is incomplete; upload the capture again`,known:`Enter the length in metres`},nothingDropped:`No files found. Upload a folder, a ZIP file or a video.`,stages:{scene:`Whole scene`,planes:`Planes`,pieces:`Connected components`,doubts:`Checking objects and cells`,look:`Inspecting the capture`,compile:`Preparing the program for this computer (once)`,photos:`Reading the photos`,poses:`Estimating camera poses`,shrink:`Resizing photos`,stereo:`Estimating depth`,plan:`Reading the floor plan`,room:`Generating a room`,capture:`Rendering camera views`,scan:`Detecting floor and walls`,register:`Aligning views`,fuse:`Fusing depth`,label:`Predicting semantic occupancy`,find:`Detecting objects`,furnish:`Matching furniture`,repair:`Comparing furniture with photos`,build:`Building blocks`,report:`Writing the report`,write:`Writing the file`,share:`Writing the page`,install:`Copying the world`,load:`Waiting for server chunks`,check:`Verifying blocks on the server`},about:e=>`about ${e} to process`,left:e=>`about ${e} left`,seconds:e=>`${e} s`,minutes:e=>`${e} min`,megabytes:e=>e>=2e3?`${Math.round(e/1024)} GB`:e>=10?`${Math.round(e)} MB`:e>=.1?`${e.toFixed(1)} MB`:`${Math.ceil(e*1024)} kB`,failed:`Failed`,cancelled:`Cancelled`,job:{done:`Done`,cancel:`Cancel`,close:`Close`}},photos:{title:`Photos`,loading:`Loading photos…`,none:`No photos`,count:e=>`${e} ${e===1?`photo`:`photos`}`,fly:e=>`Show the view of ${e}`,blend:`Photo`,ways:{scene:`Scene`,blend:`Blend`,beside:`Side by side`,photo:`Photo`},cameras:`Cameras`,classes:`Show classes`,leave:`Close`,why:`Select a photo in the strip below the scene first`},compare:{title:`Compare`,lead:`Compare the scene with another occupancy grid, such as ground truth or a prediction.`,file:`Choose file…`,truth:`Ground truth`,opened:`Original scene`,end:`Close comparison`,with:e=>`Compared with ${e}`,names:{truth:`ground truth`,opened:`the original scene`},added:`Added`,removed:`Removed`,changed:`Class changed`,iou:`IoU`,miou:`mIoU`,cells:e=>`${e.toLocaleString(`en`)} ${e===1?`cell`:`cells`}`,percent:e=>`${(100*e).toFixed(1)}%`,why:{truth:`Only generated rooms have ground truth`}},exports:{title:`Export`,menu:`Export to a file, Minecraft or a server…`,close:`Close`,lead:`Exports the current state. Does not save the scene.`,groups:{game:`Minecraft`,"3d":`3D and images`,data:`Data`},forms:{world:[`World`,`ZIP file for the saves folder`],schem:[`Sponge schematic`,`WorldEdit, FAWE`],datapack:[`Data pack`,`builds the room with a function`],litematic:[`Litematica`,``],structure:[`Structure`,`for structure blocks`],legacy:[`MCEdit schematic`,`Minecraft before 1.13`],mcfunction:[`Function file`,`one command per line`],mcstructure:[`Bedrock structure`,``],glb:[`glTF model`,`for Blender and 3D viewers`],habitat:[`Habitat scene`,`ZIP file for Habitat-Sim`],png:[`Image`,`isometric view, PNG`],npz:[`room.npz`,`all data of each cell`],occ:[`occ.json`,`cells, in the paper's format`],centers:[`centers.json`,`object centres, in the paper's format`],objects:[`objects.json`,`object boxes and rotations`],placements:[`placements.json`,`furniture placements`],stats:[`Statistics`,`cells and objects per class, CSV`]},download:`Download`,made:(e,t)=>`${e}, ${t}`,lost:e=>`not exported: ${e}`,nothingLost:`exported completely`,version:`Game version`,install:`Install in Minecraft`,installLead:`Copies the world to a Minecraft installation on this machine. Existing worlds are not changed.`,noGames:`No Minecraft installation found.`,findGame:`Choose its folder…`,name:`World name`,game:`Installation`,installed:e=>`Installed ${e}`,steps:(e,t)=>`Open it in ${e}: Singleplayer > ${t} > Play Selected World`,world:`Build in an existing world`,worldLead:`Close the world in Minecraft first. Changed files are backed up; w2m undo WORLD restores them.`,noWorlds:`No worlds found on this machine.`,worldName:`World`,at:`Position (x y z)`,atHint:`Corner of the room in block coordinates; press F3 in Minecraft to read them`,turns:`Rotation`,buildNow:`Build`,builtWorld:e=>`${e} blocks changed`,server:`Build on a running server`,serverLead:`Uses the remote console (RCON). This cannot be undone.`,address:`Address`,password:`Password`,builtServer:e=>`${e} commands sent, all checked blocks are correct`},folders:{title:`Where is Minecraft?`,lead:`No installation was found. Choose the folder of the game, usually named .minecraft, or its saves folder.`,path:`Folder`,up:`Folder above`,choose:`Choose this folder`},app:`SceneForge`,classes:e,groups:{page:`Page`,edit:`Edit`,modes:`Modes`,view:`View`,tools:`Tools`,selection:`Selection`,voxels:`Voxels`,objects:`Objects`,classes:`Classes`,walk:`Walk`,photos:`Photos`},action:{help:`Help`,palette:`All commands`,cancel:`Cancel the current action`,save:`Save to files`,export:`Export`,theme:`Switch theme`,start:`Back to the start page`,undo:`Undo`,redo:`Redo`,delete:`Delete the selection`,"mode.inspect":`Inspect`,"mode.voxels":`Voxels`,"mode.objects":`Objects`,"mode.build":`Build`,"mode.walk":`Walk`,"view.focus":`Focus on the selection`,"view.reset":`Show the whole scene`,"view.top":`Top view`,"view.front":`Front view`,"view.side":`Side view`,"view.ortho":`Switch perspective and orthographic view`,"view.hide":`Hide the selected class`,"view.unhide":`Show all classes`,"view.solo":`Show only the selected class`,"view.edges":`Show or hide cell edges`,"camera.left":`Rotate the view left`,"camera.right":`Rotate the view right`,"camera.up":`Raise the camera`,"camera.down":`Lower the camera`,"camera.panLeft":`Pan left`,"camera.panRight":`Pan right`,"camera.panUp":`Pan up`,"camera.panDown":`Pan down`,"camera.closer":`Zoom in`,"camera.away":`Zoom out`,"slice.up":`Move the slice up one cell`,"slice.down":`Move the slice down one cell`,"photo.way":`Next photo view (photo, blend, side by side, scene)`,"photo.leave":`Close the photo`,"doubtful.next":`Next issue`,"doubtful.previous":`Previous issue`,"tool.navigate":`Navigate and select`,"tool.measure":`Measure`,"tool.eyedropper":`Pick the class of a cell`,"tool.brush":`Brush`,"tool.erase":`Eraser`,"tool.box":`Box select`,"tool.lasso":`Lasso select`,"tool.flood":`Select connected cells`,"brush.smaller":`Smaller brush`,"brush.larger":`Larger brush`,"brush.shape":`Next brush shape`,surface:`Switch between surface only and full depth`,"cursor.right":`Move the cell cursor right`,"cursor.left":`Move the cell cursor left`,"cursor.away":`Move the cell cursor away`,"cursor.near":`Move the cell cursor closer`,"cursor.up":`Move the cell cursor up one layer`,"cursor.down":`Move the cell cursor down one layer`,"cursor.paint":`Paint the cell at the cursor`,"cursor.erase":`Erase the cell at the cursor`,"cells.relabel":`Assign the current class to the selected cells`,"cells.smooth":`Smooth the selection, or all objects`,"cells.fillBox":`Fill the bounding box of the selection`,"cells.copy":`Copy the selected cells`,"cells.paste":`Paste the copied cells`,"cells.component":`Delete the connected region under the pointer`,"holes.fill":`Find holes in floor, walls and ceiling`,"floaters.find":`Find floaters`,"select.all":`Select all`,"select.none":`Clear the selection`,"select.invert":`Invert the selection`,"select.undo":`Previous selection`,"select.redo":`Next selection`,"tool.move":`Move the object`,"tool.add":`Add an object`,"object.turn":`Rotate by 90°`,"object.turnBack":`Rotate back by 90°`,"object.template":`Next template`,"object.templateBack":`Previous template`,"object.split":`Split the object in two`,"object.merge":`Merge the selected objects`,"object.duplicate":`Duplicate the object`,"object.floor":`Snap to the floor`,"object.wall":`Snap to the wall`,"object.relabel":`Assign the current class to the selected objects`,"object.rematch":`Match templates again`,"walk.ask":`Go to a thing by its name`,"object.next":`Next object`,"object.previous":`Previous object`},gestures:[[`mouse.orbit`,`view`,`drag`,`Rotate the view`],[`mouse.pan`,`view`,`Shift+drag, middle drag`,`Pan the view; with a selection tool, Shift adds to the selection`],[`mouse.zoom`,`view`,`wheel`,`Zoom`],[`mouse.orbitAlways`,`view`,`right drag`,`Rotate the view while a tool is active`],[`mouse.select`,`objects`,`click`,`Select the object; Shift adds, Ctrl removes`],[`mouse.drag`,`objects`,`drag a centre`,`Move the object in steps of one cell`],[`mouse.delete`,`objects`,`right click on a centre`,`Delete the object (if the pointer moves less than 4 pixels)`],[`mouse.add`,`selection`,`Shift`,`Add to the selection`],[`mouse.subtract`,`selection`,`Ctrl`,`Remove from the selection`],[`mouse.intersect`,`selection`,`Shift+Ctrl`,`Intersect with the selection`],[`mouse.size`,`tools`,`Ctrl+wheel`,`Change the brush size`],[`walk.go`,`walk`,`W A S D`,`Walk; press W twice or hold R to run`],[`walk.jump`,`walk`,`Space`,`Jump`],[`walk.sneak`,`walk`,`Shift`,`Sneak; stops at edges`],[`walk.look`,`walk`,`arrows, or click and move the mouse`,`Look around`],[`walk.leave`,`walk`,`Escape`,`Leave Walk mode`],[`build.click`,`view`,`click in Build`,`Show the block and select its object`],[`mouse.solo`,`classes`,`Alt+click on an eye`,`Show only this class`]],cursor:(e,t)=>`Cell ${e}: ${t}`,pickClass:t=>`Set the current class: ${e[t]}`,theme:{dark:`Dark`,light:`Light`},top:{modes:`Modes`,saved:`Saved`,unsaved:`Unsaved changes`,unsavedHint:`Every change is recorded in the journal. Ctrl+S writes the files.`,readOnly:`Read-only`,undo:e=>`Undo ${e.replaceAll(`_`,` `)}`.trim(),redo:e=>`Redo ${e.replaceAll(`_`,` `)}`.trim(),offline:`Disconnected`},stage:{label:`Scene`,tools:`Tools`,options:`Tool options`,ways:`View mode`},status:{label:`Status`,none:`No cell under the pointer`,unseen:`not observed`,cell:e=>`cell ${e}`,metres:e=>`${e} m`,object:(e,t=`object`)=>`${t} ${e}`,frame:e=>`${e.toFixed(0)} ms per frame`},panels:{left:`Classes and objects`,right:`Inspector and settings`,drawer:`Drawer`,titles:{legend:`Classes`,objects:`Objects`,inspector:`Inspector`,cells:`Selected cells`,floaters:`Floaters`,holes:`Holes`,smoothing:`Smoothing`,doubtful:`Issues`,recluster:`Detect objects again`,slices:`Slices and section`,display:`Display`}},clashes:{title:`Collisions`,collides:`Collides with`,with:e=>`Collides with ${e}`,outside:`Extends beyond the room`},percent:e=>`${Math.round(e*100)}%`,centimetres:e=>`${Math.round(e*100)} cm`,metres:e=>`${e.map(e=>e.toFixed(2)).join(` × `)} m`,position:e=>`${e.map(e=>e.toFixed(2)).join(`, `)} m`,cells:e=>`${e.toLocaleString(`en`)} ${e===1?`cell`:`cells`}`,templateName:e=>e===`cells`?`voxels (no template)`:e.replaceAll(`_`,` `).replace(/\btv\b/g,`TV`),legend:{title:`Classes`,choose:(e,t)=>`Set the current class: ${e} (${t})`,more:e=>`More actions: ${e}`,seen:(e,t,n)=>n?`Only ${e} is shown. Show all classes`:`${t?`Hide`:`Show`} ${e} (Alt: show only ${e})`,locked:(e,t)=>t?`Unlock ${e}`:`Lock ${e} against changes`,relabel:`Change class…`,deleteAll:e=>`Delete all cells of class ${e}`,solo:e=>`Show only ${e}`,selectCells:e=>`Select cells of class ${e}`,selectObjects:e=>`Select objects of class ${e}`,splitEach:`Split each object in two`,mergeAll:`Merge all objects into one`,rematch:`Match templates again`,recluster:`Detect objects again`,splits:`may split or merge`},objects:{title:`Objects by class`,none:`No objects. Press N to add one, or detect objects again.`,find:`Find an object`,search:`Find by name, synonym or class`,notFound:`No object has this name.`,name:(e,t)=>`${e} ${t}`,count:e=>`${e} ${e===1?`object`:`objects`}`,fit:e=>`IoU ${Math.round(e*100)}%`,ownCells:`voxels`,iou:`IoU of the furniture template with the object's cells`},inspector:{none:`Select an object in the scene or in the list.`,several:e=>`${e} objects`,mixed:`Several classes`,name:`Name`,nameOf:e=>`${e?`Name confidence ${Math.round(e*100)}%. `:``}Choose a name or type your own; empty restores the class`,class:`Class`,templates:`Furniture templates, best first`,noTemplate:`No template fits. The object is built from its voxels.`,iouOf:(e,t)=>`${e}: IoU ${t.toFixed(3)} with the object's cells`,next:`Next`,previous:`Previous`,turn:`Rotation`,turnRight:`Rotate by 90°`,turnTo:e=>`Rotate to ${e}°`,size:`Size`,place:`Centre`,cells:`Cells`,confidence:e=>`Confidence ${Math.round(e*100)}%`,floor:`Snap to floor`,wall:`Snap to wall`,duplicate:`Duplicate`,split:`Split`,merge:`Merge`,rematch:`Rematch`,remove:`Delete`},cellsPanel:{empty:`No cells selected. Select with box (X), lasso (L) or connected cells (K). Enter assigns the current class, Delete erases.`,relabel:`Assign class`,give:e=>`Assign class ${e}`,chip:(e,t)=>`${e}: ${t}`,fillBox:`Fill box`,smooth:`Smooth`,none:`Clear`,remove:`Delete`},floaters:{title:`Floaters by size`,note:`Small regions that are not connected to anything else.`,size:`Max. size`,find:`Find`,deleteAll:`Delete all`,select:`Select and show`,found:(e,t)=>e?`${e} found, ${t.toLocaleString(`en`)} cells`:`No floaters up to this size.`},holes:{title:`Holes by plane`,note:`Missing parts of floor, walls and ceiling.`,find:`Find holes`,found:e=>e?`Select a row to fill its holes.`:`No holes found.`,plane:e=>e.startsWith(`wall:`)?`wall ${Number(e.slice(5))+1}`:e,share:e=>`${(e*100).toFixed(1)}% missing`,fill:e=>`Fill ${e.toLocaleString(`en`)}`,fillOne:e=>`Fill the holes in ${e}`},smoothing:{note:`Removes bumps and fills dents in objects with a majority filter.`,only:e=>`Smooth ${e}`,all:`Smooth all objects`,selection:`Selection`},doubtful:{title:`Issues, most uncertain first`,note:`Cells and objects that are probably wrong. Press . for the next one.`,none:`No issues found.`,at:(e,t)=>e?`${e} of ${t}`:`${t} ${t===1?`issue`:`issues`}`,next:`Next`,previous:`Previous`},recluster:{note:`Move a slider to preview the detected object centres.`,density_kernel:`Kernel size`,density_threshold:`Threshold`,cluster_radius:`Radius`,run:`Detect again`,hide:`Hide preview`,found:(e,t)=>`${e} objects (currently ${t})`},slices:{axis:`Slice along`,off:`Off`,low:`From`,high:`To`,sectionTitle:`Section box`,section:`Show only the inside of a box`,side:(e,t)=>`${e} ${t===`low`?`from`:`to`}`,toSelection:`Fit box to selection`},display:{voxelSize:`Voxel size`,opacity:`Opacity`,centerSize:`Marker size`,edges:`Cell edges`,colourBy:`Colour by`,doubtful:`0%`,colours:{class:`Class`,confidence:`Confidence`,colour:`Photo`,difference:`Difference`},legends:{class:``,confidence:`100% confidence`,colour:`Colour from the photos.`,difference:`Green: added. Red: removed. Orange: class changed.`}},tools:{moved:e=>e.map(e=>e>0?`+${e}`:e).join(`, `),copied:e=>`${e.toLocaleString(`en`)} cells copied. Ctrl+V pastes them.`,pasting:`Click to place the copy. Arrow keys move it; X, Y and Z mirror it; Esc cancels.`,measured:e=>`Distance: ${e}`,distance:(e,t)=>`${e.toFixed(2)} m  (${t.map(e=>e.toFixed(2)).join(`, `)})`,combine:`Shift: add · Ctrl: remove · Shift+Ctrl: intersect`,flood:`Click a connected region of one class`,eyedropper:`Click a cell to pick its class`,measure:`Drag from one point to another`,add:`Click to place the object`,move:`Drag an object, or press G: arrow keys move it, Enter confirms`,shape:`Brush shape`,shapes:{sphere:`Sphere`,cube:`Cube`,single:`One cell`},size:`Size`,fills:`Brush mode`,fillsWords:{empty:`Add`,occupied:`Replace`,all:`Both`},surface:`Surface only`,depth:`Depth`,through:`all`,paints:e=>`Current class: ${e}`},context:{select:(e,t)=>`Select ${e} ${t}`,focus:`Focus here`,hide:e=>`Hide ${e}`,take:e=>`Set the current class: ${e}`,component:`Delete connected region`},hints:{title:`Getting started`,close:`Dismiss`,list:[[`drag`,`rotate the view`],[`.`,`next issue`],[`?`,`all keys`]]},build:{title:`Blocks`,block:`Block`,size:`Blocks per metre`,sizes:(e,t)=>t?`${+e.toFixed(1)} (1 per voxel)`:String(e),style:`Furniture`,styles:{blocks:`Blocks`,display:`Entities`,voxels:`Voxels`},light:`Light`,lights:{even:`Uniform`,day:`Day`,night:`Night`},cutOpen:`Cut away near walls`,facts:(e,t)=>`${e.toLocaleString(`en`)} blocks, ${t} block states`,click:`Click a block to show its state.`,display:`Display entity`,partOf:e=>e?`Part of ${e}`:`Part of the room structure`,busy:`Building blocks…`,failed:`Block build failed`},walk:{title:`Walk`,through:`Show`,grounds:{blocks:`Blocks`,voxels:`Voxels`},keys:[[`W A S D`,`walk; press W twice to run`],[`Space`,`jump`],[`Shift`,`sneak; stops at edges`],[`arrows`,`look around`],[`click`,`look around with the mouse`],[`G`,`go to a thing by its name`],[`Esc`,`leave`]],hint:`Click to look around with the mouse, or use the arrow keys. Esc leaves.`,ask:{label:`Where to?`,go:`Go`,who:`Who walks`,planner:`Planner`,agentHint:e=>`${e} is shown views of these blocks and decides by itself. It costs money.`,deciding:(e,t,n)=>`${e} looks around · step ${t}${n}`,cost:(e,t)=>e===null?` · ${t} ${t===1?`request`:`requests`}`:` · $${e.toFixed(4)}`,thought:e=>` “${e}”`,agentEnd:{stopped:e=>`${e} has stopped`,"gave up":e=>`${e} gave no usable answer three times`,"out of steps":e=>`${e} has used all its steps`},agentGoal:(e,t)=>`, ${t.toFixed(1)} m of walking from the ${e}`,hint:e=>`go to the ${e}`,nothing:`Type what to go to, such as the sofa.`,soon:`The blocks are still being built. Try again in a moment.`,looking:`Looking for the way…`,walking:(e,t,n)=>n>1?`To the nearest of ${n}: ${e}, ${t.toFixed(1)} m.`:`Walking to the ${e}, ${t.toFixed(1)} m.`,arrived:e=>`Here is the ${e}.`,noWay:e=>`No way leads to the ${e} from here.`,unknown:e=>`There is no “${e}” here. Try one of these:`},thumbs:{stick:`Stick for the left thumb: walk`,look:`Drag to look around`,jump:`Jump`},ahead:(e,t)=>t?`${e} · ${t}`:e},help:{title:`Keys and gestures`,note:`On macOS, use Cmd instead of Ctrl.`,close:`Close help (Esc)`},keysPage:{title:`# Keys and gestures of SceneForge`,note:"The keys of the editor, as its help (`?`) shows them; a key in another mode than its table names that mode. On macOS, use Cmd instead of Ctrl. Letters follow the keyboard layout, digits and brackets their position on the keyboard. When a field has the focus, its own keys take precedence.",head:[`Keys`,`Action`],everywhere:`all`,modes:e=>`Modes: ${e}.`},palette:{title:`All commands`,placeholder:`Search commands`,none:`No matching command`},why:{notHere:`Not available here`,chosen:`Chosen already`,onlyIn:e=>`Only in ${e}`,elsewhere:e=>`Not in ${e}`,allShown:`All classes are shown`,smallest:`The brush is at its smallest`,largest:`The brush is at its largest`,nothingToUndo:`Nothing to undo`,nothingToRedo:`Nothing to redo`,offline:`No connection to the server`,readOnly:e=>`Read-only: ${e}`,noScene:`No scene is open`,noCursor:`Move the cell cursor with the arrow keys first`,noneOfClass:e=>`No cells of class ${e}`,locked:e=>`${e} is locked`,tooFew:e=>`Needs at least two objects of class ${e}`,noObjects:e=>e?`No objects of class ${e}`:`No objects`,notAnObject:`Choose an object class first (keys 5 to 9, 0, -)`,noPlace:`Nothing under the pointer`,nothingSelected:`Nothing selected`,noCells:`No cells selected`,aClass:`Choose a class other than empty`,emptyClass:`Choose a class other than empty; Delete erases cells`,noObject:`No object selected`,oneObject:`Select a single object`,twoObjects:`Select at least two objects; Shift+click adds`,noOtherTemplate:`No other template fits this object`,nothingCopied:`Nothing copied; Ctrl+C copies the selection`,noFloaters:`Find floaters first`,nothingToCompare:`Open a comparison first (Compare panel)`,noSelectionBefore:`No previous selection`,noSelectionAfter:`No next selection`},error:{behind:`This tab fell behind and reloaded the scene. Check whether your last edit was applied.`,lost:`Connection lost before the server answered. Reconnecting…`,offline:`No connection to the server. Nothing was changed. Check that w2m forge is running.`,protocol:`The server runs a different version. Reload the page.`,load:`Loading the scene failed`,noView:`SceneForge needs WebGL 2, which this browser does not provide. Enable hardware acceleration, or open the link in another browser.`}},r=new Map(t.map(({name:e,title:t,labels:n})=>[e,[e,t,...n]]));function i(e){return n.objects.name(e.title,e.id)}function a(e,t){let i=[...r.get(e.name)??[],e.title,n.classes[e.class_id]??``,String(e.id)].join(`
`).toLowerCase();return t.toLowerCase().split(/\s+/).every(e=>i.includes(e))}function o(e){let n=t.filter(({class_id:t})=>t===e),r=t.filter(({class_id:t})=>t!==e&&t>=5);return[...n,...r].map(({title:e})=>e)}var s=new Set([`value`,`checked`,`indeterminate`,`textContent`,`htmlFor`]);function c(e,t={},...n){let r=document.createElement(e);for(let[e,n]of Object.entries(t))n!=null&&n!==!1&&(e===`class`?r.className=n:e===`on`?f(r,n):e===`data`?Object.assign(r.dataset,n):e===`vars`?d(r,n):s.has(e)?Object.assign(r,{[e]:n}):r.setAttribute(e,n===!0?``:String(n)));return l(r,n),r}function l(e,t){for(let n of t)n!=null&&n!==!1&&e.append(n instanceof Node?n:String(n))}function u(e,...t){e.replaceChildren(),l(e,t)}function d(e,t){for(let[n,r]of Object.entries(t))e.style.setProperty(n,r)}function f(e,t){for(let[n,r]of Object.entries(t))e.addEventListener(n,r)}function p(e,t,n){t?(e.setAttribute(`aria-disabled`,`true`),e.setAttribute(`aria-description`,t),e.title=`${n} · ${t}`):(e.removeAttribute(`aria-disabled`),e.removeAttribute(`aria-description`),e.title=n)}function m(e){return e instanceof HTMLElement?e instanceof HTMLInputElement?![`range`,`checkbox`,`radio`,`button`].includes(e.type):e instanceof HTMLTextAreaElement||e.isContentEditable:!1}function h(e){let t=c(`output`,{}),n=c(`input`,{type:`range`,min:e.min,max:e.max,step:e.step,"aria-label":e.label,data:{field:e.id}}),r=r=>{n.value=String(r),t.textContent=e.show(r),n.setAttribute(`aria-valuetext`,e.show(r))};return n.addEventListener(`input`,()=>{let t=Number(n.value);r(t),e.change(t)}),{node:c(`label`,{class:`field`},c(`span`,{},e.label),n,t),input:n,set:r}}function g(e,t,n){let r=c(`div`,{class:`segment`,role:`group`,"aria-label":e});return{node:r,set:e=>{let i=r.contains(document.activeElement),a=t().map(t=>{let r=c(`button`,{type:`button`,data:{value:t.value}},t.label);return r.setAttribute(`aria-pressed`,String(t.value===e)),p(r,t.why??``,t.label),r.addEventListener(`click`,()=>{t.why||n(t.value)}),r});u(r,...a),i&&a.find(e=>e.getAttribute(`aria-pressed`)===`true`)?.focus()}}}function _(e,t,n){let r=c(`input`,{type:`checkbox`,data:{field:t}});return r.addEventListener(`change`,()=>n(r.checked)),{node:c(`label`,{class:`check`},r,e),set:e=>r.checked=e}}function v(e,t,n=`button`){let r=c(`button`,{type:`button`,class:n},e);return r.addEventListener(`click`,()=>{r.getAttribute(`aria-disabled`)!==`true`&&t()}),r}var y=new Map,b=[],x=[],S=[],C=null;function w(e,t){y.set(e,[...y.get(e)??[],t])}function T(e){b.push(e)}function E(e){x.push(e)}function D(e){S.push(e)}function O(e){C=e}var k={hooks:e=>y.get(e)??[],panels:e=>b.filter(t=>t.place===e).sort((e,t)=>e.order-t.order),stageParts:()=>x,exports:()=>S,startPage:()=>C},A=1e3,j=1001,M=1002,N=1003,ee=1004,te=1005,P=1006,ne=1007,re=1008,ie=1009,ae=1010,oe=1011,se=1012,ce=1013,F=1014,I=1015,le=1016,ue=1017,de=1018,fe=1020,pe=35902,me=35899,he=1021,ge=1022,_e=1023,ve=1026,ye=1027,be=1028,xe=1029,Se=1030,Ce=1031,we=1033,Te=33776,Ee=33777,De=33778,Oe=33779,ke=35840,Ae=35841,je=35842,Me=35843,L=36196,Ne=37492,Pe=37496,Fe=37488,R=37489,Ie=37490,z=37491,B=37808,Le=37809,Re=37810,ze=37811,Be=37812,Ve=37813,He=37814,Ue=37815,We=37816,Ge=37817,Ke=37818,qe=37819,Je=37820,Ye=37821,Xe=36492,Ze=36494,Qe=36495,$e=36283,et=36284,tt=36285,nt=36286,rt=2300,it=2301,at=2302,ot=2303,st=2400,ct=2401,lt=2402,ut=3200,dt=`srgb`,ft=`srgb-linear`,pt=`linear`,mt=`srgb`,ht=7680,gt=35044,_t=`300 es`,vt=2e3;function yt(e){for(let t=e.length-1;t>=0;--t)if(e[t]>=65535)return!0;return!1}function bt(e){return ArrayBuffer.isView(e)&&!(e instanceof DataView)}function xt(e){return document.createElementNS(`http://www.w3.org/1999/xhtml`,e)}function St(){let e=xt(`canvas`);return e.style.display=`block`,e}var Ct={};function wt(...e){let t=`THREE.`+e.shift();console.log(t,...e)}function Tt(e){let t=e[0];if(typeof t==`string`&&t.startsWith(`TSL:`)){let t=e[1];t&&t.isStackTrace?e[0]+=` `+t.getLocation():e[1]=`Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.`}return e}function V(...e){e=Tt(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.warn(n.getError(t)):console.warn(t,...e)}}function H(...e){e=Tt(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.error(n.getError(t)):console.error(t,...e)}}function Et(...e){let t=e.join(` `);t in Ct||(Ct[t]=!0,V(...e))}function Dt(e,t,n){return new Promise(function(r,i){function a(){switch(e.clientWaitSync(t,e.SYNC_FLUSH_COMMANDS_BIT,0)){case e.WAIT_FAILED:i();break;case e.TIMEOUT_EXPIRED:setTimeout(a,n);break;default:r()}}setTimeout(a,n)})}var Ot={0:0,2:6,4:4,3:5,1:1,6:2,7:7,5:3},kt=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n!==void 0&&n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let r=n[e];if(r!==void 0){let e=r.indexOf(t);e!==-1&&r.splice(e,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let t=n.slice(0);for(let n=0,r=t.length;n<r;n++)t[n].call(this,e);e.target=null}}},At=`00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f.10.11.12.13.14.15.16.17.18.19.1a.1b.1c.1d.1e.1f.20.21.22.23.24.25.26.27.28.29.2a.2b.2c.2d.2e.2f.30.31.32.33.34.35.36.37.38.39.3a.3b.3c.3d.3e.3f.40.41.42.43.44.45.46.47.48.49.4a.4b.4c.4d.4e.4f.50.51.52.53.54.55.56.57.58.59.5a.5b.5c.5d.5e.5f.60.61.62.63.64.65.66.67.68.69.6a.6b.6c.6d.6e.6f.70.71.72.73.74.75.76.77.78.79.7a.7b.7c.7d.7e.7f.80.81.82.83.84.85.86.87.88.89.8a.8b.8c.8d.8e.8f.90.91.92.93.94.95.96.97.98.99.9a.9b.9c.9d.9e.9f.a0.a1.a2.a3.a4.a5.a6.a7.a8.a9.aa.ab.ac.ad.ae.af.b0.b1.b2.b3.b4.b5.b6.b7.b8.b9.ba.bb.bc.bd.be.bf.c0.c1.c2.c3.c4.c5.c6.c7.c8.c9.ca.cb.cc.cd.ce.cf.d0.d1.d2.d3.d4.d5.d6.d7.d8.d9.da.db.dc.dd.de.df.e0.e1.e2.e3.e4.e5.e6.e7.e8.e9.ea.eb.ec.ed.ee.ef.f0.f1.f2.f3.f4.f5.f6.f7.f8.f9.fa.fb.fc.fd.fe.ff`.split(`.`),jt=1234567,Mt=Math.PI/180,Nt=180/Math.PI;function Pt(){let e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0,r=Math.random()*4294967295|0;return(At[e&255]+At[e>>8&255]+At[e>>16&255]+At[e>>24&255]+`-`+At[t&255]+At[t>>8&255]+`-`+At[t>>16&15|64]+At[t>>24&255]+`-`+At[n&63|128]+At[n>>8&255]+`-`+At[n>>16&255]+At[n>>24&255]+At[r&255]+At[r>>8&255]+At[r>>16&255]+At[r>>24&255]).toLowerCase()}function U(e,t,n){return Math.max(t,Math.min(n,e))}function Ft(e,t){return(e%t+t)%t}function It(e,t,n,r,i){return r+(e-t)*(i-r)/(n-t)}function Lt(e,t,n){return e===t?0:(n-e)/(t-e)}function Rt(e,t,n){return(1-n)*e+n*t}function zt(e,t,n,r){return Rt(e,t,1-Math.exp(-n*r))}function Bt(e,t=1){return t-Math.abs(Ft(e,t*2)-t)}function Vt(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*(3-2*e))}function Ht(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*e*(e*(e*6-15)+10))}function Ut(e,t){return e+Math.floor(Math.random()*(t-e+1))}function Wt(e,t){return e+Math.random()*(t-e)}function Gt(e){return e*(.5-Math.random())}function Kt(e){e!==void 0&&(jt=e);let t=jt+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function qt(e){return e*Mt}function Jt(e){return e*Nt}function Yt(e){return e>0&&Number.isInteger(e)&&2**Math.round(Math.log2(e))===e}function Xt(e){return 2**Math.ceil(Math.log(e)/Math.LN2)}function Zt(e){return 2**Math.floor(Math.log(e)/Math.LN2)}function Qt(e,t,n,r,i){let a=Math.cos,o=Math.sin,s=a(n/2),c=o(n/2),l=a((t+r)/2),u=o((t+r)/2),d=a((t-r)/2),f=o((t-r)/2),p=a((r-t)/2),m=o((r-t)/2);switch(i){case`XYX`:e.set(s*u,c*d,c*f,s*l);break;case`YZY`:e.set(c*f,s*u,c*d,s*l);break;case`ZXZ`:e.set(c*d,c*f,s*u,s*l);break;case`XZX`:e.set(s*u,c*m,c*p,s*l);break;case`YXY`:e.set(c*p,s*u,c*m,s*l);break;case`ZYZ`:e.set(c*m,c*p,s*u,s*l);break;default:V(`MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: `+i)}}function $t(e){switch(e.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function en(e,t){if(t.constructor===Float32Array)return e;let n=$t(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.max(e/n,-1)}function tn(e,t){if(t.constructor===Float32Array)return e;let n=$t(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.round(e*n)}var nn={DEG2RAD:Mt,RAD2DEG:Nt,generateUUID:Pt,clamp:U,euclideanModulo:Ft,mapLinear:It,inverseLerp:Lt,lerp:Rt,damp:zt,pingpong:Bt,smoothstep:Vt,smootherstep:Ht,randInt:Ut,randFloat:Wt,randFloatSpread:Gt,seededRandom:Kt,degToRad:qt,radToDeg:Jt,isPowerOfTwo:Yt,ceilPowerOfTwo:Xt,floorPowerOfTwo:Zt,setQuaternionFromProperEuler:Qt,normalize:tn,denormalize:en},W=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw Error(`THREE.Vector2: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw Error(`THREE.Vector2: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6],this.y=r[1]*t+r[4]*n+r[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=U(this.x,e.x,t.x),this.y=U(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=U(this.x,e,t),this.y=U(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(U(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(U(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),r=Math.sin(t),i=this.x-e.x,a=this.y-e.y;return this.x=i*n-a*r+e.x,this.y=i*r+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},rn=class{constructor(e=0,t=0,n=0,r=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=r}static slerpFlat(e,t,n,r,i,a,o){let s=n[r+0],c=n[r+1],l=n[r+2],u=n[r+3],d=i[a+0],f=i[a+1],p=i[a+2],m=i[a+3];if(u!==m||s!==d||c!==f||l!==p){let e=s*d+c*f+l*p+u*m;e<0&&(d=-d,f=-f,p=-p,m=-m,e=-e);let t=1-o;if(e<.9995){let n=Math.acos(e),r=Math.sin(n);t=Math.sin(t*n)/r,o=Math.sin(o*n)/r,s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o}else{s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o;let e=1/Math.sqrt(s*s+c*c+l*l+u*u);s*=e,c*=e,l*=e,u*=e}}e[t]=s,e[t+1]=c,e[t+2]=l,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,r,i,a){let o=n[r],s=n[r+1],c=n[r+2],l=n[r+3],u=i[a],d=i[a+1],f=i[a+2],p=i[a+3];return e[t]=o*p+l*u+s*f-c*d,e[t+1]=s*p+l*d+c*u-o*f,e[t+2]=c*p+l*f+o*d-s*u,e[t+3]=l*p-o*u-s*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,r){return this._x=e,this._y=t,this._z=n,this._w=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,r=e._y,i=e._z,a=e._order,o=Math.cos,s=Math.sin,c=o(n/2),l=o(r/2),u=o(i/2),d=s(n/2),f=s(r/2),p=s(i/2);switch(a){case`XYZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`YXZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`ZXY`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`ZYX`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`YZX`:this._x=d*l*u+c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u-d*f*p;break;case`XZY`:this._x=d*l*u-c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u+d*f*p;break;default:V(`Quaternion: .setFromEuler() encountered an unknown order: `+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,r=Math.sin(n);return this._x=e.x*r,this._y=e.y*r,this._z=e.z*r,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],r=t[4],i=t[8],a=t[1],o=t[5],s=t[9],c=t[2],l=t[6],u=t[10],d=n+o+u;if(d>0){let e=.5/Math.sqrt(d+1);this._w=.25/e,this._x=(l-s)*e,this._y=(i-c)*e,this._z=(a-r)*e}else if(n>o&&n>u){let e=2*Math.sqrt(1+n-o-u);this._w=(l-s)/e,this._x=.25*e,this._y=(r+a)/e,this._z=(i+c)/e}else if(o>u){let e=2*Math.sqrt(1+o-n-u);this._w=(i-c)/e,this._x=(r+a)/e,this._y=.25*e,this._z=(s+l)/e}else{let e=2*Math.sqrt(1+u-n-o);this._w=(a-r)/e,this._x=(i+c)/e,this._y=(s+l)/e,this._z=.25*e}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(U(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let r=Math.min(1,t/n);return this.slerp(e,r),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x*=e,this._y*=e,this._z*=e,this._w*=e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=t._x,s=t._y,c=t._z,l=t._w;return this._x=n*l+a*o+r*c-i*s,this._y=r*l+a*s+i*o-n*c,this._z=i*l+a*c+n*s-r*o,this._w=a*l-n*o-r*s-i*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,r=-r,i=-i,a=-a,o=-o);let s=1-t;if(o<.9995){let e=Math.acos(o),c=Math.sin(e);s=Math.sin(s*e)/c,t=Math.sin(t*e)/c,this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this._onChangeCallback()}else this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),r=Math.sqrt(1-n),i=Math.sqrt(n);return this.set(r*Math.sin(e),r*Math.cos(e),i*Math.sin(t),i*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},G=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw Error(`THREE.Vector3: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw Error(`THREE.Vector3: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(on.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(on.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[3]*n+i[6]*r,this.y=i[1]*t+i[4]*n+i[7]*r,this.z=i[2]*t+i[5]*n+i[8]*r,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=e.elements,a=1/(i[3]*t+i[7]*n+i[11]*r+i[15]);return this.x=(i[0]*t+i[4]*n+i[8]*r+i[12])*a,this.y=(i[1]*t+i[5]*n+i[9]*r+i[13])*a,this.z=(i[2]*t+i[6]*n+i[10]*r+i[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,r=this.z,i=e.x,a=e.y,o=e.z,s=e.w,c=2*(a*r-o*n),l=2*(o*t-i*r),u=2*(i*n-a*t);return this.x=t+s*c+a*u-o*l,this.y=n+s*l+o*c-i*u,this.z=r+s*u+i*l-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[4]*n+i[8]*r,this.y=i[1]*t+i[5]*n+i[9]*r,this.z=i[2]*t+i[6]*n+i[10]*r,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=U(this.x,e.x,t.x),this.y=U(this.y,e.y,t.y),this.z=U(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=U(this.x,e,t),this.y=U(this.y,e,t),this.z=U(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(U(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,r=e.y,i=e.z,a=t.x,o=t.y,s=t.z;return this.x=r*s-i*o,this.y=i*a-n*s,this.z=n*o-r*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return an.copy(this).projectOnVector(e),this.sub(an)}reflect(e){return this.sub(an.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(U(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,r=this.z-e.z;return t*t+n*n+r*r}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let r=Math.sin(t)*e;return this.x=r*Math.sin(n),this.y=Math.cos(t)*e,this.z=r*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),r=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=r,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},an=new G,on=new rn,K=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,r,i,a,o,s,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c)}set(e,t,n,r,i,a,o,s,c){let l=this.elements;return l[0]=e,l[1]=r,l[2]=o,l[3]=t,l[4]=i,l[5]=s,l[6]=n,l[7]=a,l[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[3],s=n[6],c=n[1],l=n[4],u=n[7],d=n[2],f=n[5],p=n[8],m=r[0],h=r[3],g=r[6],_=r[1],v=r[4],y=r[7],b=r[2],x=r[5],S=r[8];return i[0]=a*m+o*_+s*b,i[3]=a*h+o*v+s*x,i[6]=a*g+o*y+s*S,i[1]=c*m+l*_+u*b,i[4]=c*h+l*v+u*x,i[7]=c*g+l*y+u*S,i[2]=d*m+f*_+p*b,i[5]=d*h+f*v+p*x,i[8]=d*g+f*y+p*S,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8];return t*a*l-t*o*c-n*i*l+n*o*s+r*i*c-r*a*s}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=l*a-o*c,d=o*s-l*i,f=c*i-a*s,p=t*u+n*d+r*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let m=1/p;return e[0]=u*m,e[1]=(r*c-l*n)*m,e[2]=(o*n-r*a)*m,e[3]=d*m,e[4]=(l*t-r*s)*m,e[5]=(r*i-o*t)*m,e[6]=f*m,e[7]=(n*s-c*t)*m,e[8]=(a*t-n*i)*m,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,r,i,a,o){let s=Math.cos(i),c=Math.sin(i);return this.set(n*s,n*c,-n*(s*a+c*o)+a+e,-r*c,r*s,-r*(-c*a+s*o)+o+t,0,0,1),this}scale(e,t){return Et(`Matrix3: .scale() is deprecated. Use .makeScale() instead.`),this.premultiply(sn.makeScale(e,t)),this}rotate(e){return Et(`Matrix3: .rotate() is deprecated. Use .makeRotation() instead.`),this.premultiply(sn.makeRotation(-e)),this}translate(e,t){return Et(`Matrix3: .translate() is deprecated. Use .makeTranslation() instead.`),this.premultiply(sn.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<9;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},sn=new K,cn=new K().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),ln=new K().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function un(){let e={enabled:!0,workingColorSpace:ft,spaces:{},convert:function(e,t,n){return this.enabled===!1||t===n||!t||!n||(this.spaces[t].transfer===`srgb`&&(e.r=dn(e.r),e.g=dn(e.g),e.b=dn(e.b)),this.spaces[t].primaries!==this.spaces[n].primaries&&(e.applyMatrix3(this.spaces[t].toXYZ),e.applyMatrix3(this.spaces[n].fromXYZ)),this.spaces[n].transfer===`srgb`&&(e.r=fn(e.r),e.g=fn(e.g),e.b=fn(e.b))),e},workingToColorSpace:function(e,t){return this.convert(e,this.workingColorSpace,t)},colorSpaceToWorking:function(e,t){return this.convert(e,t,this.workingColorSpace)},getPrimaries:function(e){return this.spaces[e].primaries},getTransfer:function(e){return e===``?pt:this.spaces[e].transfer},getToneMappingMode:function(e){return this.spaces[e].outputColorSpaceConfig.toneMappingMode||`standard`},getLuminanceCoefficients:function(e,t=this.workingColorSpace){return e.fromArray(this.spaces[t].luminanceCoefficients)},define:function(e){Object.assign(this.spaces,e)},_getMatrix:function(e,t,n){return e.copy(this.spaces[n].fromXYZ).multiply(this.spaces[t].toXYZ)},_getDrawingBufferColorSpace:function(e){return this.spaces[e].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(e=this.workingColorSpace){return this.spaces[e].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],n=[.2126,.7152,.0722],r=[.3127,.329];return e.define({[ft]:{primaries:t,whitePoint:r,transfer:pt,toXYZ:cn,fromXYZ:ln,luminanceCoefficients:n,workingColorSpaceConfig:{unpackColorSpace:dt},outputColorSpaceConfig:{drawingBufferColorSpace:dt}},[dt]:{primaries:t,whitePoint:r,transfer:mt,toXYZ:cn,fromXYZ:ln,luminanceCoefficients:n,outputColorSpaceConfig:{drawingBufferColorSpace:dt}}}),e}var q=un();function dn(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}function fn(e){return e<.0031308?e*12.92:1.055*e**.41666-.055}var pn,mn=class{static getDataURL(e,t=`image/png`){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>`u`)return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{pn===void 0&&(pn=xt(`canvas`)),pn.width=e.width,pn.height=e.height;let t=pn.getContext(`2d`);e instanceof ImageData?t.putImageData(e,0,0):t.drawImage(e,0,0,e.width,e.height),n=pn}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap){let t=xt(`canvas`);t.width=e.width,t.height=e.height;let n=t.getContext(`2d`);n.drawImage(e,0,0,e.width,e.height);let r=n.getImageData(0,0,e.width,e.height),i=r.data;for(let e=0;e<i.length;e++)i[e]=dn(i[e]/255)*255;return n.putImageData(r,0,0),t}if(e.data){let t=e.data.slice(0);for(let e=0;e<t.length;e++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[e]=Math.floor(dn(t[e]/255)*255):t[e]=dn(t[e]);return{data:t,width:e.width,height:e.height}}return V(`ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied.`),e}},hn=0,gn=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:hn++}),this.uuid=Pt(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<`u`&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<`u`&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t===null?e.set(0,0,0):e.set(t.width||0,t.height||0,t.depth||0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:``},r=this.data;if(r!==null){let e;if(Array.isArray(r)){e=[];for(let t=0,n=r.length;t<n;t++)r[t].isDataTexture?e.push(_n(r[t].image)):e.push(_n(r[t]))}else e=_n(r);n.url=e}return t||(e.images[this.uuid]=n),n}};function _n(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap?mn.getDataURL(e):e.data?{data:Array.from(e.data),width:e.width,height:e.height,type:e.data.constructor.name}:(V(`Texture: Unable to serialize Texture.`),{})}var vn=0,yn=new G,bn=class e extends kt{constructor(t=e.DEFAULT_IMAGE,n=e.DEFAULT_MAPPING,r=j,i=j,a=P,o=re,s=_e,c=ie,l=e.DEFAULT_ANISOTROPY,u=``){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:vn++}),this.uuid=Pt(),this.name=``,this.source=new gn(t),this.mipmaps=[],this.mapping=n,this.channel=0,this.wrapS=r,this.wrapT=i,this.magFilter=a,this.minFilter=o,this.anisotropy=l,this.format=s,this.internalFormat=null,this.type=c,this.offset=new W(0,0),this.repeat=new W(1,1),this.center=new W(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new K,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(yn).x}get height(){return this.source.getSize(yn).y}get depth(){return this.source.getSize(yn).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){V(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?V(`Texture.setValues(): property '${t}' does not exist.`):r&&n&&r.isVector2&&n.isVector2||r&&n&&r.isVector3&&n.isVector3||r&&n&&r.isMatrix3&&n.isMatrix3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:`Texture`,generator:`Texture.toJSON`},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:`dispose`})}transformUv(e){if(this.mapping!==300)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case A:e.x-=Math.floor(e.x);break;case j:e.x=e.x<0?0:1;break;case M:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x-=Math.floor(e.x)}if(e.y<0||e.y>1)switch(this.wrapT){case A:e.y-=Math.floor(e.y);break;case j:e.y=e.y<0?0:1;break;case M:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y-=Math.floor(e.y)}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};bn.DEFAULT_IMAGE=null,bn.DEFAULT_MAPPING=300,bn.DEFAULT_ANISOTROPY=1;var J=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,r=1){this.x=e,this.y=t,this.z=n,this.w=r}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,r){return this.x=e,this.y=t,this.z=n,this.w=r,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw Error(`THREE.Vector4: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw Error(`THREE.Vector4: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w===void 0?1:e.w,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*r+a[12]*i,this.y=a[1]*t+a[5]*n+a[9]*r+a[13]*i,this.z=a[2]*t+a[6]*n+a[10]*r+a[14]*i,this.w=a[3]*t+a[7]*n+a[11]*r+a[15]*i,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,r,i,a=.01,o=.1,s=e.elements,c=s[0],l=s[4],u=s[8],d=s[1],f=s[5],p=s[9],m=s[2],h=s[6],g=s[10];if(Math.abs(l-d)<a&&Math.abs(u-m)<a&&Math.abs(p-h)<a){if(Math.abs(l+d)<o&&Math.abs(u+m)<o&&Math.abs(p+h)<o&&Math.abs(c+f+g-3)<o)return this.set(1,0,0,0),this;t=Math.PI;let e=(c+1)/2,s=(f+1)/2,_=(g+1)/2,v=(l+d)/4,y=(u+m)/4,b=(p+h)/4;return e>s&&e>_?e<a?(n=0,r=.707106781,i=.707106781):(n=Math.sqrt(e),r=v/n,i=y/n):s>_?s<a?(n=.707106781,r=0,i=.707106781):(r=Math.sqrt(s),n=v/r,i=b/r):_<a?(n=.707106781,r=.707106781,i=0):(i=Math.sqrt(_),n=y/i,r=b/i),this.set(n,r,i,t),this}let _=Math.sqrt((h-p)*(h-p)+(u-m)*(u-m)+(d-l)*(d-l));return Math.abs(_)<.001&&(_=1),this.x=(h-p)/_,this.y=(u-m)/_,this.z=(d-l)/_,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=U(this.x,e.x,t.x),this.y=U(this.y,e.y,t.y),this.z=U(this.z,e.z,t.z),this.w=U(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=U(this.x,e,t),this.y=U(this.y,e,t),this.z=U(this.z,e,t),this.w=U(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(U(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},xn=class extends kt{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:P,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new J(0,0,e,t),this.scissorTest=!1,this.viewport=new J(0,0,e,t),this.textures=[];let r=n.count;for(let i=0;i<r;i++)this.textures[i]=new bn({width:e,height:t,depth:n.depth}),this.textures[i].isRenderTargetTexture=!0,this.textures[i].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:P,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let e=0;e<this.textures.length;e++)this.textures[e].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let r=0,i=this.textures.length;r<i;r++)this.textures[r].image.width=e,this.textures[r].image.height=t,this.textures[r].image.depth=n,this.textures[r].isData3DTexture!==!0&&(this.textures[r].isArrayTexture=this.textures[r].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let n=Object.assign({},e.textures[t].image);this.textures[t].source=new gn(n)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null){if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture}else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:`dispose`})}},Sn=class extends xn{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},Cn=class extends bn{constructor(e=null,t=1,n=1,r=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=N,this.minFilter=N,this.wrapR=j,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}},wn=class extends bn{constructor(e=null,t=1,n=1,r=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=N,this.minFilter=N,this.wrapR=j,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}},Y=class e{static{this.prototype.isMatrix4=!0}constructor(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h)}set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=r,g[1]=i,g[5]=a,g[9]=o,g[13]=s,g[2]=c,g[6]=l,g[10]=u,g[14]=d,g[3]=f,g[7]=p,g[11]=m,g[15]=h,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new e().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,r=1/Tn.setFromMatrixColumn(e,0).length(),i=1/Tn.setFromMatrixColumn(e,1).length(),a=1/Tn.setFromMatrixColumn(e,2).length();return t[0]=n[0]*r,t[1]=n[1]*r,t[2]=n[2]*r,t[3]=0,t[4]=n[4]*i,t[5]=n[5]*i,t[6]=n[6]*i,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,r=e.y,i=e.z,a=Math.cos(n),o=Math.sin(n),s=Math.cos(r),c=Math.sin(r),l=Math.cos(i),u=Math.sin(i);if(e.order===`XYZ`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=-s*u,t[8]=c,t[1]=n+r*c,t[5]=e-i*c,t[9]=-o*s,t[2]=i-e*c,t[6]=r+n*c,t[10]=a*s}else if(e.order===`YXZ`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e+i*o,t[4]=r*o-n,t[8]=a*c,t[1]=a*u,t[5]=a*l,t[9]=-o,t[2]=n*o-r,t[6]=i+e*o,t[10]=a*s}else if(e.order===`ZXY`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e-i*o,t[4]=-a*u,t[8]=r+n*o,t[1]=n+r*o,t[5]=a*l,t[9]=i-e*o,t[2]=-a*c,t[6]=o,t[10]=a*s}else if(e.order===`ZYX`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=r*c-n,t[8]=e*c+i,t[1]=s*u,t[5]=i*c+e,t[9]=n*c-r,t[2]=-c,t[6]=o*s,t[10]=a*s}else if(e.order===`YZX`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=i-e*u,t[8]=r*u+n,t[1]=u,t[5]=a*l,t[9]=-o*l,t[2]=-c*l,t[6]=n*u+r,t[10]=e-i*u}else if(e.order===`XZY`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=-u,t[8]=c*l,t[1]=e*u+i,t[5]=a*l,t[9]=n*u-r,t[2]=r*u-n,t[6]=o*l,t[10]=i*u+e}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Dn,e,On)}lookAt(e,t,n){let r=this.elements;return jn.subVectors(e,t),jn.lengthSq()===0&&(jn.z=1),jn.normalize(),kn.crossVectors(n,jn),kn.lengthSq()===0&&(Math.abs(n.z)===1?jn.x+=1e-4:jn.z+=1e-4,jn.normalize(),kn.crossVectors(n,jn)),kn.normalize(),An.crossVectors(jn,kn),r[0]=kn.x,r[4]=An.x,r[8]=jn.x,r[1]=kn.y,r[5]=An.y,r[9]=jn.y,r[2]=kn.z,r[6]=An.z,r[10]=jn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[4],s=n[8],c=n[12],l=n[1],u=n[5],d=n[9],f=n[13],p=n[2],m=n[6],h=n[10],g=n[14],_=n[3],v=n[7],y=n[11],b=n[15],x=r[0],S=r[4],C=r[8],w=r[12],T=r[1],E=r[5],D=r[9],O=r[13],k=r[2],A=r[6],j=r[10],M=r[14],N=r[3],ee=r[7],te=r[11],P=r[15];return i[0]=a*x+o*T+s*k+c*N,i[4]=a*S+o*E+s*A+c*ee,i[8]=a*C+o*D+s*j+c*te,i[12]=a*w+o*O+s*M+c*P,i[1]=l*x+u*T+d*k+f*N,i[5]=l*S+u*E+d*A+f*ee,i[9]=l*C+u*D+d*j+f*te,i[13]=l*w+u*O+d*M+f*P,i[2]=p*x+m*T+h*k+g*N,i[6]=p*S+m*E+h*A+g*ee,i[10]=p*C+m*D+h*j+g*te,i[14]=p*w+m*O+h*M+g*P,i[3]=_*x+v*T+y*k+b*N,i[7]=_*S+v*E+y*A+b*ee,i[11]=_*C+v*D+y*j+b*te,i[15]=_*w+v*O+y*M+b*P,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[12],a=e[1],o=e[5],s=e[9],c=e[13],l=e[2],u=e[6],d=e[10],f=e[14],p=e[3],m=e[7],h=e[11],g=e[15],_=s*f-c*d,v=o*f-c*u,y=o*d-s*u,b=a*f-c*l,x=a*d-s*l,S=a*u-o*l;return t*(m*_-h*v+g*y)-n*(p*_-h*b+g*x)+r*(p*v-m*b+g*S)-i*(p*y-m*x+h*S)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[1],a=e[5],o=e[9],s=e[2],c=e[6],l=e[10];return t*(a*l-o*c)-n*(i*l-o*s)+r*(i*c-a*s)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let r=this.elements;return e.isVector3?(r[12]=e.x,r[13]=e.y,r[14]=e.z):(r[12]=e,r[13]=t,r[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=e[9],d=e[10],f=e[11],p=e[12],m=e[13],h=e[14],g=e[15],_=t*o-n*a,v=t*s-r*a,y=t*c-i*a,b=n*s-r*o,x=n*c-i*o,S=r*c-i*s,C=l*m-u*p,w=l*h-d*p,T=l*g-f*p,E=u*h-d*m,D=u*g-f*m,O=d*g-f*h,k=_*O-v*D+y*E+b*T-x*w+S*C;if(k===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let A=1/k;return e[0]=(o*O-s*D+c*E)*A,e[1]=(r*D-n*O-i*E)*A,e[2]=(m*S-h*x+g*b)*A,e[3]=(d*x-u*S-f*b)*A,e[4]=(s*T-a*O-c*w)*A,e[5]=(t*O-r*T+i*w)*A,e[6]=(h*y-p*S-g*v)*A,e[7]=(l*S-d*y+f*v)*A,e[8]=(a*D-o*T+c*C)*A,e[9]=(n*T-t*D-i*C)*A,e[10]=(p*x-m*y+g*_)*A,e[11]=(u*y-l*x-f*_)*A,e[12]=(o*w-a*E-s*C)*A,e[13]=(t*E-n*w+r*C)*A,e[14]=(m*v-p*b-h*_)*A,e[15]=(l*b-u*v+d*_)*A,this}scale(e){let t=this.elements,n=e.x,r=e.y,i=e.z;return t[0]*=n,t[4]*=r,t[8]*=i,t[1]*=n,t[5]*=r,t[9]*=i,t[2]*=n,t[6]*=r,t[10]*=i,t[3]*=n,t[7]*=r,t[11]*=i,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],r=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,r))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),r=Math.sin(t),i=1-n,a=e.x,o=e.y,s=e.z,c=i*a,l=i*o;return this.set(c*a+n,c*o-r*s,c*s+r*o,0,c*o+r*s,l*o+n,l*s-r*a,0,c*s-r*o,l*s+r*a,i*s*s+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,r,i,a){return this.set(1,n,i,0,e,1,a,0,t,r,1,0,0,0,0,1),this}compose(e,t,n){let r=this.elements,i=t._x,a=t._y,o=t._z,s=t._w,c=i+i,l=a+a,u=o+o,d=i*c,f=i*l,p=i*u,m=a*l,h=a*u,g=o*u,_=s*c,v=s*l,y=s*u,b=n.x,x=n.y,S=n.z;return r[0]=(1-(m+g))*b,r[1]=(f+y)*b,r[2]=(p-v)*b,r[3]=0,r[4]=(f-y)*x,r[5]=(1-(d+g))*x,r[6]=(h+_)*x,r[7]=0,r[8]=(p+v)*S,r[9]=(h-_)*S,r[10]=(1-(d+m))*S,r[11]=0,r[12]=e.x,r[13]=e.y,r[14]=e.z,r[15]=1,this}decompose(e,t,n){let r=this.elements;e.x=r[12],e.y=r[13],e.z=r[14];let i=this.determinantAffine();if(i===0)return n.set(1,1,1),t.identity(),this;let a=Tn.set(r[0],r[1],r[2]).length(),o=Tn.set(r[4],r[5],r[6]).length(),s=Tn.set(r[8],r[9],r[10]).length();i<0&&(a=-a),En.copy(this);let c=1/a,l=1/o,u=1/s;return En.elements[0]*=c,En.elements[1]*=c,En.elements[2]*=c,En.elements[4]*=l,En.elements[5]*=l,En.elements[6]*=l,En.elements[8]*=u,En.elements[9]*=u,En.elements[10]*=u,t.setFromRotationMatrix(En),n.x=a,n.y=o,n.z=s,this}makePerspective(e,t,n,r,i,a,o=vt,s=!1){let c=this.elements,l=2*i/(t-e),u=2*i/(n-r),d=(t+e)/(t-e),f=(n+r)/(n-r),p,m;if(s)p=i/(a-i),m=a*i/(a-i);else if(o===2e3)p=-(a+i)/(a-i),m=-2*a*i/(a-i);else if(o===2001)p=-a/(a-i),m=-a*i/(a-i);else throw Error(`THREE.Matrix4.makePerspective(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,r,i,a,o=vt,s=!1){let c=this.elements,l=2/(t-e),u=2/(n-r),d=-(t+e)/(t-e),f=-(n+r)/(n-r),p,m;if(s)p=1/(a-i),m=a/(a-i);else if(o===2e3)p=-2/(a-i),m=-(a+i)/(a-i);else if(o===2001)p=-1/(a-i),m=-i/(a-i);else throw Error(`THREE.Matrix4.makeOrthographic(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<16;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Tn=new G,En=new Y,Dn=new G(0,0,0),On=new G(1,1,1),kn=new G,An=new G,jn=new G,Mn=new Y,Nn=new rn,Pn=class e{constructor(t=0,n=0,r=0,i=e.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=n,this._z=r,this._order=i}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,r=this._order){return this._x=e,this._y=t,this._z=n,this._order=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let r=e.elements,i=r[0],a=r[4],o=r[8],s=r[1],c=r[5],l=r[9],u=r[2],d=r[6],f=r[10];switch(t){case`XYZ`:this._y=Math.asin(U(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-l,f),this._z=Math.atan2(-a,i)):(this._x=Math.atan2(d,c),this._z=0);break;case`YXZ`:this._x=Math.asin(-U(l,-1,1)),Math.abs(l)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(s,c)):(this._y=Math.atan2(-u,i),this._z=0);break;case`ZXY`:this._x=Math.asin(U(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(s,i));break;case`ZYX`:this._y=Math.asin(-U(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(s,i)):(this._x=0,this._z=Math.atan2(-a,c));break;case`YZX`:this._z=Math.asin(U(s,-1,1)),Math.abs(s)<.9999999?(this._x=Math.atan2(-l,c),this._y=Math.atan2(-u,i)):(this._x=0,this._y=Math.atan2(o,f));break;case`XZY`:this._z=Math.asin(-U(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(o,i)):(this._x=Math.atan2(-l,f),this._y=0);break;default:V(`Euler: .setFromRotationMatrix() encountered an unknown order: `+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return Mn.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Mn,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Nn.setFromEuler(this),this.setFromQuaternion(Nn,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Pn.DEFAULT_ORDER=`XYZ`;var Fn=class{constructor(){this.mask=1}set(e){this.mask=1<<e>>>0}enable(e){this.mask|=1<<e}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e}disable(e){this.mask&=~(1<<e)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return!!(this.mask&1<<e)}},In=0,Ln=new G,Rn=new rn,zn=new Y,Bn=new G,Vn=new G,Hn=new G,Un=new rn,Wn=new G(1,0,0),Gn=new G(0,1,0),Kn=new G(0,0,1),qn={type:`added`},Jn={type:`removed`},Yn={type:`childadded`,child:null},Xn={type:`childremoved`,child:null},Zn=class e extends kt{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:In++}),this.uuid=Pt(),this.name=``,this.type=`Object3D`,this.parent=null,this.children=[],this.up=e.DEFAULT_UP.clone();let t=new G,n=new Pn,r=new rn,i=new G(1,1,1);function a(){r.setFromEuler(n,!1)}function o(){n.setFromQuaternion(r,void 0,!1)}n._onChange(a),r._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:n},quaternion:{configurable:!0,enumerable:!0,value:r},scale:{configurable:!0,enumerable:!0,value:i},modelViewMatrix:{value:new Y},normalMatrix:{value:new K}}),this.matrix=new Y,this.matrixWorld=new Y,this.matrixAutoUpdate=e.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=e.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Fn,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return Rn.setFromAxisAngle(e,t),this.quaternion.multiply(Rn),this}rotateOnWorldAxis(e,t){return Rn.setFromAxisAngle(e,t),this.quaternion.premultiply(Rn),this}rotateX(e){return this.rotateOnAxis(Wn,e)}rotateY(e){return this.rotateOnAxis(Gn,e)}rotateZ(e){return this.rotateOnAxis(Kn,e)}translateOnAxis(e,t){return Ln.copy(e).applyQuaternion(this.quaternion),this.position.add(Ln.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(Wn,e)}translateY(e){return this.translateOnAxis(Gn,e)}translateZ(e){return this.translateOnAxis(Kn,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(zn.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Bn.copy(e):Bn.set(e,t,n);let r=this.parent;this.updateWorldMatrix(!0,!1),Vn.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?zn.lookAt(Vn,Bn,this.up):zn.lookAt(Bn,Vn,this.up),this.quaternion.setFromRotationMatrix(zn),r&&(zn.extractRotation(r.matrixWorld),Rn.setFromRotationMatrix(zn),this.quaternion.premultiply(Rn.invert()))}add(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return e===this?(H(`Object3D.add: object can't be added as a child of itself.`,e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(qn),Yn.child=e,this.dispatchEvent(Yn),Yn.child=null):H(`Object3D.add: object not an instance of THREE.Object3D.`,e),this)}remove(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.remove(arguments[e]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Jn),Xn.child=e,this.dispatchEvent(Xn),Xn.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),zn.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),zn.multiply(e.parent.matrixWorld)),e.applyMatrix4(zn),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(qn),Yn.child=e,this.dispatchEvent(Yn),Yn.child=null,this}getObjectById(e){return this.getObjectByProperty(`id`,e)}getObjectByName(e){return this.getObjectByProperty(`name`,e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,r=this.children.length;n<r;n++){let r=this.children[n].getObjectByProperty(e,t);if(r!==void 0)return r}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let r=this.children;for(let i=0,a=r.length;i<a;i++)r[i].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Vn,e,Hn),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Vn,Un,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,r=e.z,i=this.matrix.elements;i[12]+=t-i[0]*t-i[4]*n-i[8]*r,i[13]+=n-i[1]*t-i[5]*n-i[9]*r,i[14]+=r-i[2]*t-i[6]*n-i[10]*r}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let r=this.parent;if(e===!0&&r!==null&&r.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let e=this.children;for(let t=0,r=e.length;t<r;t++)e[t].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e==`string`,n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:`Object`,generator:`Object3D.toJSON`});let r={};r.uuid=this.uuid,r.type=this.type,r.name=this.name,r.castShadow=this.castShadow,r.receiveShadow=this.receiveShadow,r.visible=this.visible,r.frustumCulled=this.frustumCulled,r.renderOrder=this.renderOrder,r.static=this.static,r.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(r.userData=this.userData),r.layers=this.layers.mask,r.matrix=this.matrix.toArray(),r.up=this.up.toArray(),this.pivot!==null&&(r.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(r.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(r.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(r.type=`InstancedMesh`,r.count=this.count,r.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(r.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(r.type=`BatchedMesh`,r.perObjectFrustumCulled=this.perObjectFrustumCulled,r.sortObjects=this.sortObjects,r.drawRanges=this._drawRanges,r.reservedRanges=this._reservedRanges,r.geometryInfo=this._geometryInfo.map(e=>({...e,boundingBox:e.boundingBox?e.boundingBox.toJSON():void 0,boundingSphere:e.boundingSphere?e.boundingSphere.toJSON():void 0})),r.instanceInfo=this._instanceInfo.map(e=>({...e})),r.availableInstanceIds=this._availableInstanceIds.slice(),r.availableGeometryIds=this._availableGeometryIds.slice(),r.nextIndexStart=this._nextIndexStart,r.nextVertexStart=this._nextVertexStart,r.geometryCount=this._geometryCount,r.maxInstanceCount=this._maxInstanceCount,r.maxVertexCount=this._maxVertexCount,r.maxIndexCount=this._maxIndexCount,r.geometryInitialized=this._geometryInitialized,r.matricesTexture=this._matricesTexture.toJSON(e),r.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(r.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(r.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(r.boundingBox=this.boundingBox.toJSON()));function i(t,n){return t[n.uuid]===void 0&&(t[n.uuid]=n.toJSON(e)),n.uuid}if(this.isScene)this.background&&(this.background.isColor?r.background=this.background.toJSON():this.background.isTexture&&(r.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(r.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){r.geometry=i(e.geometries,this.geometry);let t=this.geometry.parameters;if(t!==void 0&&t.shapes!==void 0){let n=t.shapes;if(Array.isArray(n))for(let t=0,r=n.length;t<r;t++){let r=n[t];i(e.shapes,r)}else i(e.shapes,n)}}if(this.isSkinnedMesh&&(r.bindMode=this.bindMode,r.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(i(e.skeletons,this.skeleton),r.skeleton=this.skeleton.uuid)),this.material!==void 0){if(Array.isArray(this.material)){let t=[];for(let n=0,r=this.material.length;n<r;n++)t.push(i(e.materials,this.material[n]));r.material=t}else r.material=i(e.materials,this.material)}if(this.children.length>0){r.children=[];for(let t=0;t<this.children.length;t++)r.children.push(this.children[t].toJSON(e).object)}if(this.animations.length>0){r.animations=[];for(let t=0;t<this.animations.length;t++){let n=this.animations[t];r.animations.push(i(e.animations,n))}}if(t){let t=a(e.geometries),r=a(e.materials),i=a(e.textures),o=a(e.images),s=a(e.shapes),c=a(e.skeletons),l=a(e.animations),u=a(e.nodes);t.length>0&&(n.geometries=t),r.length>0&&(n.materials=r),i.length>0&&(n.textures=i),o.length>0&&(n.images=o),s.length>0&&(n.shapes=s),c.length>0&&(n.skeletons=c),l.length>0&&(n.animations=l),u.length>0&&(n.nodes=u)}return n.object=r,n;function a(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot===null?null:e.pivot.clone(),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let t=0;t<e.children.length;t++){let n=e.children[t];this.add(n.clone())}return this}dispose(){this.dispatchEvent({type:`dispose`})}};Zn.DEFAULT_UP=new G(0,1,0),Zn.DEFAULT_MATRIX_AUTO_UPDATE=!0,Zn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Qn=class extends Zn{constructor(){super(),this.isGroup=!0,this.type=`Group`}},$n={type:`move`},er=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Qn,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Qn,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new G,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new G),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Qn,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new G,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new G,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:`connected`,data:e}),this}disconnect(e){return this.dispatchEvent({type:`disconnected`,data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let r=null,i=null,a=null,o=this._targetRay,s=this._grip,c=this._hand;if(e&&t.session.visibilityState!==`visible-blurred`){if(c&&e.hand){a=!0;for(let r of e.hand.values()){let e=t.getJointPose(r,n),i=this._getHandJoint(c,r);e!==null&&(i.matrix.fromArray(e.transform.matrix),i.matrix.decompose(i.position,i.quaternion,i.scale),i.matrixWorldNeedsUpdate=!0,i.jointRadius=e.radius),i.visible=e!==null}let r=c.joints[`index-finger-tip`],i=c.joints[`thumb-tip`],o=r.position.distanceTo(i.position);c.inputState.pinching&&o>.025?(c.inputState.pinching=!1,this.dispatchEvent({type:`pinchend`,handedness:e.handedness,target:this})):!c.inputState.pinching&&o<=.015&&(c.inputState.pinching=!0,this.dispatchEvent({type:`pinchstart`,handedness:e.handedness,target:this}))}else s!==null&&e.gripSpace&&(i=t.getPose(e.gripSpace,n),i!==null&&(s.matrix.fromArray(i.transform.matrix),s.matrix.decompose(s.position,s.quaternion,s.scale),s.matrixWorldNeedsUpdate=!0,i.linearVelocity?(s.hasLinearVelocity=!0,s.linearVelocity.copy(i.linearVelocity)):s.hasLinearVelocity=!1,i.angularVelocity?(s.hasAngularVelocity=!0,s.angularVelocity.copy(i.angularVelocity)):s.hasAngularVelocity=!1,s.eventsEnabled&&s.dispatchEvent({type:`gripUpdated`,data:e,target:this})));o!==null&&(r=t.getPose(e.targetRaySpace,n),r===null&&i!==null&&(r=i),r!==null&&(o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,r.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(r.linearVelocity)):o.hasLinearVelocity=!1,r.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(r.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent($n)))}return o!==null&&(o.visible=r!==null),s!==null&&(s.visible=i!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new Qn;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},tr={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},nr={h:0,s:0,l:0},rr={h:0,s:0,l:0};function ir(e,t,n){return n<0&&(n+=1),n>1&&--n,n<1/6?e+(t-e)*6*n:n<1/2?t:n<2/3?e+(t-e)*6*(2/3-n):e}var X=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let t=e;t&&t.isColor?this.copy(t):typeof t==`number`?this.setHex(t):typeof t==`string`&&this.setStyle(t)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=dt){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,q.colorSpaceToWorking(this,t),this}setRGB(e,t,n,r=q.workingColorSpace){return this.r=e,this.g=t,this.b=n,q.colorSpaceToWorking(this,r),this}setHSL(e,t,n,r=q.workingColorSpace){if(e=Ft(e,1),t=U(t,0,1),n=U(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,i=2*n-r;this.r=ir(i,r,e+1/3),this.g=ir(i,r,e),this.b=ir(i,r,e-1/3)}return q.colorSpaceToWorking(this,r),this}setStyle(e,t=dt){function n(t){t!==void 0&&parseFloat(t)<1&&V(`Color: Alpha component of `+e+` will be ignored.`)}let r;if(r=/^(\w+)\(([^\)]*)\)/.exec(e)){let i,a=r[1],o=r[2];switch(a){case`rgb`:case`rgba`:if(i=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(255,parseInt(i[1],10))/255,Math.min(255,parseInt(i[2],10))/255,Math.min(255,parseInt(i[3],10))/255,t);if(i=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(100,parseFloat(i[1]))/100,Math.min(100,parseFloat(i[2]))/100,Math.min(100,parseFloat(i[3]))/100,t);break;case`hsl`:case`hsla`:if(i=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setHSL(parseFloat(i[1])/360,parseFloat(i[2])/100,parseFloat(i[3])/100,t);break;default:V(`Color: Unknown color model `+e)}}else if(r=/^\#([A-Fa-f\d]+)$/.exec(e)){let n=r[1],i=n.length;if(i===3)return this.setRGB(parseInt(n.charAt(0),16)/15,parseInt(n.charAt(1),16)/15,parseInt(n.charAt(2),16)/15,t);if(i===6)return this.setHex(parseInt(n,16),t);V(`Color: Invalid hex color `+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=dt){let n=tr[e.toLowerCase()];return n===void 0?V(`Color: Unknown color `+e):this.setHex(n,t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=dn(e.r),this.g=dn(e.g),this.b=dn(e.b),this}copyLinearToSRGB(e){return this.r=fn(e.r),this.g=fn(e.g),this.b=fn(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=dt){return q.workingToColorSpace(ar.copy(this),e),Math.round(U(ar.r*255,0,255))*65536+Math.round(U(ar.g*255,0,255))*256+Math.round(U(ar.b*255,0,255))}getHexString(e=dt){return(`000000`+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=q.workingColorSpace){q.workingToColorSpace(ar.copy(this),t);let n=ar.r,r=ar.g,i=ar.b,a=Math.max(n,r,i),o=Math.min(n,r,i),s,c,l=(o+a)/2;if(o===a)s=0,c=0;else{let e=a-o;switch(c=l<=.5?e/(a+o):e/(2-a-o),a){case n:s=(r-i)/e+(r<i?6:0);break;case r:s=(i-n)/e+2;break;case i:s=(n-r)/e+4}s/=6}return e.h=s,e.s=c,e.l=l,e}getRGB(e,t=q.workingColorSpace){return q.workingToColorSpace(ar.copy(this),t),e.r=ar.r,e.g=ar.g,e.b=ar.b,e}getStyle(e=dt){q.workingToColorSpace(ar.copy(this),e);let t=ar.r,n=ar.g,r=ar.b;return e===`srgb`?`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(r*255)})`:`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${r.toFixed(3)})`}offsetHSL(e,t,n){return this.getHSL(nr),this.setHSL(nr.h+e,nr.s+t,nr.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(nr),e.getHSL(rr);let n=Rt(nr.h,rr.h,t),r=Rt(nr.s,rr.s,t),i=Rt(nr.l,rr.l,t);return this.setHSL(n,r,i),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,r=this.b,i=e.elements;return this.r=i[0]*t+i[3]*n+i[6]*r,this.g=i[1]*t+i[4]*n+i[7]*r,this.b=i[2]*t+i[5]*n+i[8]*r,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},ar=new X;X.NAMES=tr;var or=class extends Zn{constructor(){super(),this.isScene=!0,this.type=`Scene`,this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Pn,this.environmentIntensity=1,this.environmentRotation=new Pn,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background===null?null:e.background.clone(),this.environment=e.environment===null?null:e.environment.clone(),this.fog=e.fog===null?null:e.fog.clone(),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial===null?null:e.overrideMaterial.clone(),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},sr=new G,cr=new G,lr=new G,ur=new G,dr=new G,fr=new G,pr=new G,mr=new G,hr=new G,gr=new G,_r=new J,vr=new J,yr=new J,br=class e{constructor(e=new G,t=new G,n=new G){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,r){r.subVectors(n,t),sr.subVectors(e,t),r.cross(sr);let i=r.lengthSq();return i>0?r.multiplyScalar(1/Math.sqrt(i)):r.set(0,0,0)}static getBarycoord(e,t,n,r,i){sr.subVectors(r,t),cr.subVectors(n,t),lr.subVectors(e,t);let a=sr.dot(sr),o=sr.dot(cr),s=sr.dot(lr),c=cr.dot(cr),l=cr.dot(lr),u=a*c-o*o;if(u===0)return i.set(0,0,0),null;let d=1/u,f=(c*s-o*l)*d,p=(a*l-o*s)*d;return i.set(1-f-p,p,f)}static containsPoint(e,t,n,r){return this.getBarycoord(e,t,n,r,ur)!==null&&ur.x>=0&&ur.y>=0&&ur.x+ur.y<=1}static getInterpolation(e,t,n,r,i,a,o,s){return this.getBarycoord(e,t,n,r,ur)===null?(s.x=0,s.y=0,`z`in s&&(s.z=0),`w`in s&&(s.w=0),null):(s.setScalar(0),s.addScaledVector(i,ur.x),s.addScaledVector(a,ur.y),s.addScaledVector(o,ur.z),s)}static getInterpolatedAttribute(e,t,n,r,i,a){return _r.setScalar(0),vr.setScalar(0),yr.setScalar(0),_r.fromBufferAttribute(e,t),vr.fromBufferAttribute(e,n),yr.fromBufferAttribute(e,r),a.setScalar(0),a.addScaledVector(_r,i.x),a.addScaledVector(vr,i.y),a.addScaledVector(yr,i.z),a}static isFrontFacing(e,t,n,r){return sr.subVectors(n,t),cr.subVectors(e,t),sr.cross(cr).dot(r)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,r){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[r]),this}setFromAttributeAndIndices(e,t,n,r){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,r),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return sr.subVectors(this.c,this.b),cr.subVectors(this.a,this.b),sr.cross(cr).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return e.getNormal(this.a,this.b,this.c,t)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,n){return e.getBarycoord(t,this.a,this.b,this.c,n)}getInterpolation(t,n,r,i,a){return e.getInterpolation(t,this.a,this.b,this.c,n,r,i,a)}containsPoint(t){return e.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return e.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,r=this.b,i=this.c,a,o;dr.subVectors(r,n),fr.subVectors(i,n),mr.subVectors(e,n);let s=dr.dot(mr),c=fr.dot(mr);if(s<=0&&c<=0)return t.copy(n);hr.subVectors(e,r);let l=dr.dot(hr),u=fr.dot(hr);if(l>=0&&u<=l)return t.copy(r);let d=s*u-l*c;if(d<=0&&s>=0&&l<=0&&s-l>0)return a=s/(s-l),t.copy(n).addScaledVector(dr,a);gr.subVectors(e,i);let f=dr.dot(gr),p=fr.dot(gr);if(p>=0&&f<=p)return t.copy(i);let m=f*c-s*p;if(m<=0&&c>=0&&p<=0)return o=c/(c-p),t.copy(n).addScaledVector(fr,o);let h=l*p-f*u;if(h<=0&&u-l>=0&&f-p>=0)return pr.subVectors(i,r),o=(u-l)/(u-l+(f-p)),t.copy(r).addScaledVector(pr,o);let g=1/(h+m+d);return a=m*g,o=d*g,t.copy(n).addScaledVector(dr,a).addScaledVector(fr,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},xr=class{constructor(e=new G(1/0,1/0,1/0),t=new G(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Cr.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Cr.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Cr.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute(`position`);if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let t=0,n=r.count;t<n;t++)e.isMesh===!0?e.getVertexPosition(t,Cr):Cr.fromBufferAttribute(r,t),Cr.applyMatrix4(e.matrixWorld),this.expandByPoint(Cr);else e.boundingBox===void 0?(n.boundingBox===null&&n.computeBoundingBox(),wr.copy(n.boundingBox)):(e.boundingBox===null&&e.computeBoundingBox(),wr.copy(e.boundingBox)),wr.applyMatrix4(e.matrixWorld),this.union(wr)}let r=e.children;for(let e=0,n=r.length;e<n;e++)this.expandByObject(r[e],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Cr),Cr.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(jr),Mr.subVectors(this.max,jr),Tr.subVectors(e.a,jr),Er.subVectors(e.b,jr),Dr.subVectors(e.c,jr),Or.subVectors(Er,Tr),kr.subVectors(Dr,Er),Ar.subVectors(Tr,Dr);let t=[0,-Or.z,Or.y,0,-kr.z,kr.y,0,-Ar.z,Ar.y,Or.z,0,-Or.x,kr.z,0,-kr.x,Ar.z,0,-Ar.x,-Or.y,Or.x,0,-kr.y,kr.x,0,-Ar.y,Ar.x,0];return!Fr(t,Tr,Er,Dr,Mr)||(t=[1,0,0,0,1,0,0,0,1],!Fr(t,Tr,Er,Dr,Mr))?!1:(Nr.crossVectors(Or,kr),t=[Nr.x,Nr.y,Nr.z],Fr(t,Tr,Er,Dr,Mr))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Cr).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Cr).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()||(Sr[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Sr[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Sr[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Sr[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Sr[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Sr[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Sr[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Sr[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Sr)),this}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Sr=[new G,new G,new G,new G,new G,new G,new G,new G],Cr=new G,wr=new xr,Tr=new G,Er=new G,Dr=new G,Or=new G,kr=new G,Ar=new G,jr=new G,Mr=new G,Nr=new G,Pr=new G;function Fr(e,t,n,r,i){for(let a=0,o=e.length-3;a<=o;a+=3){Pr.fromArray(e,a);let o=i.x*Math.abs(Pr.x)+i.y*Math.abs(Pr.y)+i.z*Math.abs(Pr.z),s=t.dot(Pr),c=n.dot(Pr),l=r.dot(Pr);if(Math.max(-Math.max(s,c,l),Math.min(s,c,l))>o)return!1}return!0}var Ir=new G,Lr=new W,Rr=0,zr=class extends kt{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw TypeError(`THREE.BufferAttribute: array should be a Typed Array.`);this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Rr++}),this.name=``,this.array=e,this.itemSize=t,this.count=e===void 0?0:e.length/t,this.normalized=n,this.usage=gt,this.updateRanges=[],this.gpuType=I,this.version=0,this._normalizationScale=e===void 0?void 0:$t(e)}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let r=0,i=this.itemSize;r<i;r++)this.array[e+r]=t.array[n+r];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)Lr.fromBufferAttribute(this,t),Lr.applyMatrix3(e),this.setXY(t,Lr.x,Lr.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)Ir.fromBufferAttribute(this,t),Ir.applyMatrix3(e),this.setXYZ(t,Ir.x,Ir.y,Ir.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)Ir.fromBufferAttribute(this,t),Ir.applyMatrix4(e),this.setXYZ(t,Ir.x,Ir.y,Ir.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Ir.fromBufferAttribute(this,t),Ir.applyNormalMatrix(e),this.setXYZ(t,Ir.x,Ir.y,Ir.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Ir.fromBufferAttribute(this,t),Ir.transformDirection(e),this.setXYZ(t,Ir.x,Ir.y,Ir.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this.array[e+3]=i,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:`dispose`})}_denormalize(e){let t=this._normalizationScale;return t===void 0?en(e,this.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?tn(e,this.array):Math.round(e*t)}},Br=class extends zr{constructor(e,t,n){super(new Uint16Array(e),t,n)}},Vr=class extends zr{constructor(e,t,n){super(new Uint32Array(e),t,n)}},Hr=class extends zr{constructor(e,t,n){super(new Float32Array(e),t,n)}},Ur=new xr,Wr=new G,Gr=new G,Kr=class{constructor(e=new G,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t===void 0?Ur.setFromPoints(e).getCenter(n):n.copy(t);let r=0;for(let t=0,i=e.length;t<i;t++)r=Math.max(r,n.distanceToSquared(e[t]));return this.radius=Math.sqrt(r),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius*=e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;Wr.subVectors(e,this.center);let t=Wr.lengthSq();if(t>this.radius*this.radius){let e=Math.sqrt(t),n=(e-this.radius)*.5;this.center.addScaledVector(Wr,n/e),this.radius+=n}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Gr.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(Wr.copy(e.center).add(Gr)),this.expandByPoint(Wr.copy(e.center).sub(Gr))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},qr=0,Jr=new Y,Yr=new Zn,Xr=new G,Zr=new xr,Qr=new xr,$r=new G,ei=class e extends kt{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:qr++}),this.uuid=Pt(),this.name=``,this.type=`BufferGeometry`,this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return this.index=Array.isArray(e)?new(yt(e)?Vr:Br)(e,1):e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let t=new K().getNormalMatrix(e);n.applyNormalMatrix(t),n.needsUpdate=!0}let r=this.attributes.tangent;return r!==void 0&&(r.transformDirection(e),r.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Jr.makeRotationFromQuaternion(e),this.applyMatrix4(Jr),this}rotateX(e){return Jr.makeRotationX(e),this.applyMatrix4(Jr),this}rotateY(e){return Jr.makeRotationY(e),this.applyMatrix4(Jr),this}rotateZ(e){return Jr.makeRotationZ(e),this.applyMatrix4(Jr),this}translate(e,t,n){return Jr.makeTranslation(e,t,n),this.applyMatrix4(Jr),this}scale(e,t,n){return Jr.makeScale(e,t,n),this.applyMatrix4(Jr),this}lookAt(e){return Yr.lookAt(e),Yr.updateMatrix(),this.applyMatrix4(Yr.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Xr).negate(),this.translate(Xr.x,Xr.y,Xr.z),this}setFromPoints(e){let t=this.getAttribute(`position`);if(t===void 0){let t=[];for(let n=0,r=e.length;n<r;n++){let r=e[n];t.push(r.x,r.y,r.z||0)}this.setAttribute(`position`,new Hr(t,3))}else{let n=Math.min(e.length,t.count);for(let r=0;r<n;r++){let n=e[r];t.setXYZ(r,n.x,n.y,n.z||0)}e.length>t.count&&V(`BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry.`),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new xr);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)H(`BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.`,this),this.boundingBox.set(new G(-1/0,-1/0,-1/0),new G(1/0,1/0,1/0));else{if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];Zr.setFromBufferAttribute(n),this.morphTargetsRelative?($r.addVectors(this.boundingBox.min,Zr.min),this.boundingBox.expandByPoint($r),$r.addVectors(this.boundingBox.max,Zr.max),this.boundingBox.expandByPoint($r)):(this.boundingBox.expandByPoint(Zr.min),this.boundingBox.expandByPoint(Zr.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&H(`BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.`,this)}}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Kr);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)H(`BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.`,this),this.boundingSphere.set(new G,1/0);else if(e){let n=this.boundingSphere.center;if(Zr.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];Qr.setFromBufferAttribute(n),this.morphTargetsRelative?($r.addVectors(Zr.min,Qr.min),Zr.expandByPoint($r),$r.addVectors(Zr.max,Qr.max),Zr.expandByPoint($r)):(Zr.expandByPoint(Qr.min),Zr.expandByPoint(Qr.max))}Zr.getCenter(n);let r=0;for(let t=0,i=e.count;t<i;t++)$r.fromBufferAttribute(e,t),r=Math.max(r,n.distanceToSquared($r));if(t)for(let i=0,a=t.length;i<a;i++){let a=t[i],o=this.morphTargetsRelative;for(let t=0,i=a.count;t<i;t++)$r.fromBufferAttribute(a,t),o&&(Xr.fromBufferAttribute(e,t),$r.add(Xr)),r=Math.max(r,n.distanceToSquared($r))}this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&H(`BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.`,this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){H(`BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)`);return}let n=t.position,r=t.normal,i=t.uv,a=this.getAttribute(`tangent`);(a===void 0||a.count!==n.count)&&(a=new zr(new Float32Array(4*n.count),4),this.setAttribute(`tangent`,a));let o=[],s=[],c=new Uint8Array(n.count);for(let e=0;e<n.count;e++)o[e]=new G,s[e]=new G;let l=new G,u=new G,d=new G,f=new W,p=new W,m=new W,h=new G,g=new G;function _(e,t,r){c[e]=c[t]=c[r]=1,l.fromBufferAttribute(n,e),u.fromBufferAttribute(n,t),d.fromBufferAttribute(n,r),f.fromBufferAttribute(i,e),p.fromBufferAttribute(i,t),m.fromBufferAttribute(i,r),u.sub(l),d.sub(l),p.sub(f),m.sub(f);let a=1/(p.x*m.y-m.x*p.y);isFinite(a)&&(h.copy(u).multiplyScalar(m.y).addScaledVector(d,-p.y).multiplyScalar(a),g.copy(d).multiplyScalar(p.x).addScaledVector(u,-m.x).multiplyScalar(a),o[e].add(h),o[t].add(h),o[r].add(h),s[e].add(g),s[t].add(g),s[r].add(g))}let v=this.groups;v.length===0&&(v=[{start:0,count:e.count}]);for(let t=0,n=v.length;t<n;++t){let n=v[t],r=n.start,i=n.count;for(let t=r,n=r+i;t<n;t+=3)_(e.getX(t+0),e.getX(t+1),e.getX(t+2))}let y=new G,b=new G,x=new G,S=new G;function C(e){x.fromBufferAttribute(r,e),S.copy(x);let t=o[e];y.copy(t),y.sub(x.multiplyScalar(x.dot(t))).normalize(),b.crossVectors(S,t);let n=b.dot(s[e])<0?-1:1;a.setXYZW(e,y.x,y.y,y.z,n)}for(let e=0,t=n.count;e<t;++e)c[e]&&C(e);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute(`position`);if(t!==void 0){let n=this.getAttribute(`normal`);if(n===void 0||n.count!==t.count)n=new zr(new Float32Array(t.count*3),3),this.setAttribute(`normal`,n);else for(let e=0,t=n.count;e<t;e++)n.setXYZ(e,0,0,0);let r=new G,i=new G,a=new G,o=new G,s=new G,c=new G,l=new G,u=new G;if(e)for(let d=0,f=e.count;d<f;d+=3){let f=e.getX(d+0),p=e.getX(d+1),m=e.getX(d+2);r.fromBufferAttribute(t,f),i.fromBufferAttribute(t,p),a.fromBufferAttribute(t,m),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),o.fromBufferAttribute(n,f),s.fromBufferAttribute(n,p),c.fromBufferAttribute(n,m),o.add(l),s.add(l),c.add(l),n.setXYZ(f,o.x,o.y,o.z),n.setXYZ(p,s.x,s.y,s.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let e=0,o=t.count;e<o;e+=3)r.fromBufferAttribute(t,e+0),i.fromBufferAttribute(t,e+1),a.fromBufferAttribute(t,e+2),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),n.setXYZ(e+0,l.x,l.y,l.z),n.setXYZ(e+1,l.x,l.y,l.z),n.setXYZ(e+2,l.x,l.y,l.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)$r.fromBufferAttribute(e,t),$r.normalize(),e.setXYZ(t,$r.x,$r.y,$r.z)}toNonIndexed(){function t(e,t){let n=e.array,r=e.itemSize,i=e.normalized,a=new n.constructor(t.length*r),o=0,s=0;for(let i=0,c=t.length;i<c;i++){o=e.isInterleavedBufferAttribute?t[i]*e.data.stride+e.offset:t[i]*r;for(let e=0;e<r;e++)a[s++]=n[o++]}return new zr(a,r,i)}if(this.index===null)return V(`BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed.`),this;let n=new e,r=this.index.array,i=this.attributes;for(let e in i){let a=i[e],o=t(a,r);n.setAttribute(e,o)}let a=this.morphAttributes;for(let e in a){let i=[],o=a[e];for(let e=0,n=o.length;e<n;e++){let n=o[e],a=t(n,r);i.push(a)}n.morphAttributes[e]=i}n.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let e=0,t=o.length;e<t;e++){let t=o[e];n.addGroup(t.start,t.count,t.materialIndex)}return n}toJSON(){let e={metadata:{version:4.7,type:`BufferGeometry`,generator:`BufferGeometry.toJSON`}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?`BufferGeometry`:this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let t=this.parameters;for(let n in t)t[n]!==void 0&&(e[n]=t[n]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let t in n){let r=n[t];e.data.attributes[t]=r.toJSON(e.data)}let r={},i=!1;for(let t in this.morphAttributes){let n=this.morphAttributes[t],a=[];for(let t=0,r=n.length;t<r;t++){let r=n[t];a.push(r.toJSON(e.data))}a.length>0&&(r[t]=a,i=!0)}i&&(e.data.morphAttributes=r,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let r=e.attributes;for(let e in r){let n=r[e];this.setAttribute(e,n.clone(t))}let i=e.morphAttributes;for(let e in i){let n=[],r=i[e];for(let e=0,i=r.length;e<i;e++)n.push(r[e].clone(t));this.morphAttributes[e]=n}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let e=0,t=a.length;e<t;e++){let t=a[e];this.addGroup(t.start,t.count,t.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let s=e.boundingSphere;return s!==null&&(this.boundingSphere=s.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:`dispose`})}},ti=class{constructor(e,t){this.isInterleavedBuffer=!0,this.array=e,this.stride=t,this.count=e===void 0?0:e.length/t,this.usage=gt,this.updateRanges=[],this.version=0,this.uuid=Pt()}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.array=new e.array.constructor(e.array),this.count=e.count,this.stride=e.stride,this.usage=e.usage,this}copyAt(e,t,n){e*=this.stride,n*=t.stride;for(let r=0,i=this.stride;r<i;r++)this.array[e+r]=t.array[n+r];return this}set(e,t=0){return this.array.set(e,t),this}clone(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=ni(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=this.array.slice(0).buffer);let n=new this.array.constructor(e.arrayBuffers[t]),r=new this.constructor(n,this.stride);return r.setUsage(this.usage),r}onUpload(e){return this.onUploadCallback=e,this}toJSON(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=ni(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=Array.from(new Uint32Array(this.array.slice(0).buffer)));let n={uuid:this.uuid,buffer:t,type:this.array.constructor.name,stride:this.stride};return n.usage=this.usage,n}};function ni(e){return e.buffer._uuid===void 0&&(e.buffer._uuid=Pt()),e.byteOffset===0&&e.byteLength===e.buffer.byteLength?e.buffer._uuid:e.buffer._uuid+`:`+e.byteOffset+`:`+e.byteLength}var ri=new G,ii=class e{constructor(e,t,n,r=!1){this.isInterleavedBufferAttribute=!0,this.name=``,this.data=e,this.itemSize=t,this.offset=n,this.normalized=r,this._normalizationScale=e===void 0?void 0:$t(e.array)}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(e){this.data.needsUpdate=e}applyMatrix4(e){for(let t=0,n=this.data.count;t<n;t++)ri.fromBufferAttribute(this,t),ri.applyMatrix4(e),this.setXYZ(t,ri.x,ri.y,ri.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)ri.fromBufferAttribute(this,t),ri.applyNormalMatrix(e),this.setXYZ(t,ri.x,ri.y,ri.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)ri.fromBufferAttribute(this,t),ri.transformDirection(e),this.setXYZ(t,ri.x,ri.y,ri.z);return this}getComponent(e,t){let n=this.array[e*this.data.stride+this.offset+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.data.array[e*this.data.stride+this.offset+t]=n,this}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset]=t,this}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+1]=t,this}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+2]=t,this}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+3]=t,this}getX(e){let t=this.data.array[e*this.data.stride+this.offset];return this.normalized&&(t=this._denormalize(t)),t}getY(e){let t=this.data.array[e*this.data.stride+this.offset+1];return this.normalized&&(t=this._denormalize(t)),t}getZ(e){let t=this.data.array[e*this.data.stride+this.offset+2];return this.normalized&&(t=this._denormalize(t)),t}getW(e){let t=this.data.array[e*this.data.stride+this.offset+3];return this.normalized&&(t=this._denormalize(t)),t}setXY(e,t,n){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.data.array[e+0]=t,this.data.array[e+1]=n,this}setXYZ(e,t,n,r){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this.data.array[e+3]=i,this}clone(t){if(t===void 0){wt(`InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return new zr(new this.array.constructor(e),this.itemSize,this.normalized)}return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.clone(t)),new e(t.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(e){if(e===void 0){wt(`InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:e,normalized:this.normalized}}return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.toJSON(e)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}_denormalize(e){let t=this._normalizationScale;return t===void 0?en(e,this.data.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?tn(e,this.data.array):Math.round(e*t)}},ai=new G,oi=new G,si=new K,ci=class{constructor(e=new G(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,r){return this.normal.set(e,t,n),this.constant=r,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let r=ai.subVectors(n,t).cross(oi.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(r,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let r=e.delta(ai),i=this.normal.dot(r);if(i===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/i;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(r,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||si.getNormalMatrix(e),r=this.coplanarPoint(ai).applyMatrix4(e),i=this.normal.applyMatrix3(n).normalize();return this.constant=-r.dot(i),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},li=0,ui=class extends kt{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:li++}),this.uuid=Pt(),this.name=``,this.type=`Material`,this.blending=1,this.side=0,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=204,this.blendDst=205,this.blendEquation=100,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new X(0,0,0),this.blendAlpha=0,this.depthFunc=3,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=519,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=ht,this.stencilZFail=ht,this.stencilZPass=ht,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){V(`Material: parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?V(`Material: '${t}' is not a property of THREE.${this.type}.`):r&&r.isColor?r.set(n):r&&r.isVector2&&n&&n.isVector2||r&&r.isEuler&&n&&n.isEuler||r&&r.isVector3&&n&&n.isVector3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:`Material`,generator:`Material.toJSON`}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(e=>e.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function r(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}if(t){let t=r(e.textures),i=r(e.images);t.length>0&&(n.textures=t),i.length>0&&(n.images=i)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new X().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(e=>new ci().fromJSON(e))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(this.vertexColors=typeof e.vertexColors==`number`?e.vertexColors>0:e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let t=e.normalScale;Array.isArray(t)===!1&&(t=[t,t]),this.normalScale=new W().fromArray(t)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new W().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let e=t.length;n=Array(e);for(let r=0;r!==e;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:`dispose`})}set needsUpdate(e){e===!0&&this.version++}},di=new G,fi=new G,pi=new G,mi=new G,hi=class{constructor(e=new G,t=new G(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,di)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=di.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(di.copy(this.origin).addScaledVector(this.direction,t),di.distanceToSquared(e))}distanceSqToSegment(e,t,n,r){fi.copy(e).add(t).multiplyScalar(.5),pi.copy(t).sub(e).normalize(),mi.copy(this.origin).sub(fi);let i=e.distanceTo(t)*.5,a=-this.direction.dot(pi),o=mi.dot(this.direction),s=-mi.dot(pi),c=mi.lengthSq(),l=Math.abs(1-a*a),u,d,f,p;if(l>0){if(u=a*s-o,d=a*o-s,p=i*l,u>=0){if(d>=-p){if(d<=p){let e=1/l;u*=e,d*=e,f=u*(u+a*d+2*o)+d*(a*u+d+2*s)+c}else d=i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d=-i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d<=-p?(u=Math.max(0,-(-a*i+o)),d=u>0?-i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c):d<=p?(u=0,d=Math.min(Math.max(-i,-s),i),f=d*(d+2*s)+c):(u=Math.max(0,-(a*i+o)),d=u>0?i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c)}else d=a>0?-i:i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),r&&r.copy(fi).addScaledVector(pi,d),f}intersectSphere(e,t){if(e.radius<0)return null;di.subVectors(e.center,this.origin);let n=di.dot(this.direction),r=di.dot(di)-n*n,i=e.radius*e.radius;if(r>i)return null;let a=Math.sqrt(i-r),o=n-a,s=n+a;return s<0?null:o<0?this.at(s,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,r,i,a,o,s,c=1/this.direction.x,l=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,r=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,r=(e.min.x-d.x)*c),l>=0?(i=(e.min.y-d.y)*l,a=(e.max.y-d.y)*l):(i=(e.max.y-d.y)*l,a=(e.min.y-d.y)*l),n>a||i>r||((i>n||isNaN(n))&&(n=i),(a<r||isNaN(r))&&(r=a),u>=0?(o=(e.min.z-d.z)*u,s=(e.max.z-d.z)*u):(o=(e.max.z-d.z)*u,s=(e.min.z-d.z)*u),n>s||o>r)||((o>n||n!==n)&&(n=o),(s<r||r!==r)&&(r=s),r<0)?null:this.at(n>=0?n:r,t)}intersectsBox(e){return this.intersectBox(e,di)!==null}intersectTriangle(e,t,n,r,i){let a=this.origin,o=this.direction,s=o.x,c=o.y,l=o.z,u=e.x-a.x,d=e.y-a.y,f=e.z-a.z,p=t.x-a.x,m=t.y-a.y,h=t.z-a.z,g=n.x-a.x,_=n.y-a.y,v=n.z-a.z,y=Math.abs(s),b=Math.abs(c),x=Math.abs(l),S,C,w,T,E,D,O,k,A,j,M,N;if(y>=b&&y>=x?(w=s,D=u,A=p,N=g,s>=0?(S=c,C=l,T=d,E=f,O=m,k=h,j=_,M=v):(S=l,C=c,T=f,E=d,O=h,k=m,j=v,M=_)):b>=x?(w=c,D=d,A=m,N=_,c>=0?(S=l,C=s,T=f,E=u,O=h,k=p,j=v,M=g):(S=s,C=l,T=u,E=f,O=p,k=h,j=g,M=v)):(w=l,D=f,A=h,N=v,l>=0?(S=s,C=c,T=u,E=d,O=p,k=m,j=g,M=_):(S=c,C=s,T=d,E=u,O=m,k=p,j=_,M=g)),w===0)return null;let ee=S/w,te=C/w,P=1/w,ne=T-ee*D,re=E-te*D,ie=O-ee*A,ae=k-te*A,oe=j-ee*N,se=M-te*N,ce=oe*ae-se*ie,F=ne*se-re*oe,I=ie*re-ae*ne;if(r){if(ce<0||F<0||I<0)return null}else if((ce<0||F<0||I<0)&&(ce>0||F>0||I>0))return null;let le=ce+F+I;if(le===0)return null;let ue=P*(ce*D+F*A+I*N);return(le>0?ue<0:ue>0)?null:this.at(ue/le,i)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},gi=class extends ui{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type=`MeshBasicMaterial`,this.color=new X(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Pn,this.combine=0,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},_i=new Y,vi=new hi,yi=new Kr,bi=new G,xi=new G,Si=new G,Ci=new G,wi=new G,Ti=new G,Ei=new G,Di=new G,Oi=class extends Zn{constructor(e=new ei,t=new gi){super(),this.isMesh=!0,this.type=`Mesh`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}getVertexPosition(e,t){let n=this.geometry,r=n.attributes.position,i=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(r,e);let o=this.morphTargetInfluences;if(i&&o){Ti.set(0,0,0);for(let n=0,r=i.length;n<r;n++){let r=o[n],s=i[n];r!==0&&(wi.fromBufferAttribute(s,e),a?Ti.addScaledVector(wi,r):Ti.addScaledVector(wi.sub(t),r))}t.add(Ti)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.material,i=this.matrixWorld;r!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),yi.copy(n.boundingSphere),yi.applyMatrix4(i),vi.copy(e.ray).recast(e.near),yi.containsPoint(vi.origin)===!1&&(vi.intersectSphere(yi,bi)===null||vi.origin.distanceToSquared(bi)>(e.far-e.near)**2)||(_i.copy(i).invert(),vi.copy(e.ray).applyMatrix4(_i),(n.boundingBox===null||vi.intersectsBox(n.boundingBox)!==!1)&&this._computeIntersections(e,t,vi)))}_computeIntersections(e,t,n){let r,i=this.geometry,a=this.material,o=i.index,s=i.attributes.position,c=i.attributes.uv,l=i.attributes.uv1,u=i.attributes.normal,d=i.groups,f=i.drawRange;if(o!==null){if(Array.isArray(a))for(let i=0,s=d.length;i<s;i++){let s=d[i],p=a[s.materialIndex],m=Math.max(s.start,f.start),h=Math.min(o.count,Math.min(s.start+s.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=o.getX(i),d=o.getX(i+1),f=o.getX(i+2);r=Ai(this,p,e,n,c,l,u,a,d,f),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=s.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),s=Math.min(o.count,f.start+f.count);for(let d=i,f=s;d<f;d+=3){let i=o.getX(d),s=o.getX(d+1),f=o.getX(d+2);r=Ai(this,a,e,n,c,l,u,i,s,f),r&&(r.faceIndex=Math.floor(d/3),t.push(r))}}}else if(s!==void 0){if(Array.isArray(a))for(let i=0,o=d.length;i<o;i++){let o=d[i],p=a[o.materialIndex],m=Math.max(o.start,f.start),h=Math.min(s.count,Math.min(o.start+o.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=i,s=i+1,d=i+2;r=Ai(this,p,e,n,c,l,u,a,s,d),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=o.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),o=Math.min(s.count,f.start+f.count);for(let s=i,d=o;s<d;s+=3){let i=s,o=s+1,d=s+2;r=Ai(this,a,e,n,c,l,u,i,o,d),r&&(r.faceIndex=Math.floor(s/3),t.push(r))}}}}};function ki(e,t,n,r,i,a,o,s){let c;if(c=t.side===1?r.intersectTriangle(o,a,i,!0,s):r.intersectTriangle(i,a,o,t.side===0,s),c===null)return null;Di.copy(s),Di.applyMatrix4(e.matrixWorld);let l=n.ray.origin.distanceTo(Di);return l<n.near||l>n.far?null:{distance:l,point:Di.clone(),object:e}}function Ai(e,t,n,r,i,a,o,s,c,l){e.getVertexPosition(s,xi),e.getVertexPosition(c,Si),e.getVertexPosition(l,Ci);let u=ki(e,t,n,r,xi,Si,Ci,Ei);if(u){let e=new G;br.getBarycoord(Ei,xi,Si,Ci,e),i&&(u.uv=br.getInterpolatedAttribute(i,s,c,l,e,new W)),a&&(u.uv1=br.getInterpolatedAttribute(a,s,c,l,e,new W)),o&&(u.normal=br.getInterpolatedAttribute(o,s,c,l,e,new G),u.normal.dot(r.direction)>0&&u.normal.multiplyScalar(-1));let t={a:s,b:c,c:l,normal:new G,materialIndex:0};br.getNormal(xi,Si,Ci,t.normal),u.face=t,u.barycoord=e}return u}var ji=class extends bn{constructor(e=null,t=1,n=1,r,i,a,o,s,c=N,l=N,u,d){super(null,a,o,s,c,l,r,i,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}},Mi=class extends zr{constructor(e,t,n,r=1){super(e,t,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=r}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}toJSON(){let e=super.toJSON();return e.meshPerAttribute=this.meshPerAttribute,e.isInstancedBufferAttribute=!0,e}},Ni=new Y,Pi=new Y,Fi=[],Ii=new xr,Li=new Y,Ri=new Oi,zi=new Kr,Bi=class extends Oi{constructor(e,t,n){super(e,t),this.isInstancedMesh=!0,this.instanceMatrix=new Mi(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let e=0;e<n;e++)this.setMatrixAt(e,Li)}computeBoundingBox(){let e=this.geometry,t=this.count;this.boundingBox===null&&(this.boundingBox=new xr),e.boundingBox===null&&e.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Ni),Ii.copy(e.boundingBox).applyMatrix4(Ni),this.boundingBox.union(Ii)}computeBoundingSphere(){let e=this.geometry,t=this.count;this.boundingSphere===null&&(this.boundingSphere=new Kr),e.boundingSphere===null&&e.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Ni),zi.copy(e.boundingSphere).applyMatrix4(Ni),this.boundingSphere.union(zi)}copy(e,t){return super.copy(e,t),this.instanceMatrix.copy(e.instanceMatrix),this.morphTexture=e.morphTexture===null?null:e.morphTexture.clone(),this.instanceColor=e.instanceColor===null?null:e.instanceColor.clone(),this.count=e.count,this.boundingBox=e.boundingBox===null?null:e.boundingBox.clone(),this.boundingSphere=e.boundingSphere===null?null:e.boundingSphere.clone(),this}getColorAt(e,t){return this.instanceColor===null?t.setRGB(1,1,1):t.fromArray(this.instanceColor.array,e*3)}getMatrixAt(e,t){return t.fromArray(this.instanceMatrix.array,e*16)}getMorphAt(e,t){let n=t.morphTargetInfluences,r=this.morphTexture.source.data.data,i=e*(n.length+1)+1;for(let e=0;e<n.length;e++)n[e]=r[i+e]}raycast(e,t){let n=this.matrixWorld,r=this.count;if(Ri.geometry=this.geometry,Ri.material=this.material,Ri.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),zi.copy(this.boundingSphere),zi.applyMatrix4(n),e.ray.intersectsSphere(zi)!==!1))for(let i=0;i<r;i++){this.getMatrixAt(i,Ni),Pi.multiplyMatrices(n,Ni),Ri.matrixWorld=Pi,Ri.raycast(e,Fi);for(let e=0,n=Fi.length;e<n;e++){let n=Fi[e];n.instanceId=i,n.object=this,t.push(n)}Fi.length=0}}setColorAt(e,t){return this.instanceColor===null&&(this.instanceColor=new Mi(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),t.toArray(this.instanceColor.array,e*3),this}setMatrixAt(e,t){return t.toArray(this.instanceMatrix.array,e*16),this}setMorphAt(e,t){let n=t.morphTargetInfluences,r=n.length+1;this.morphTexture===null&&(this.morphTexture=new ji(new Float32Array(r*this.count),r,this.count,be,I));let i=this.morphTexture.source.data.data,a=0;for(let e=0;e<n.length;e++)a+=n[e];let o=this.geometry.morphTargetsRelative?1:1-a,s=r*e;return i[s]=o,i.set(n,s+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},Vi=new Kr,Hi=new W(.5,.5),Ui=new G,Wi=class{constructor(e=new ci,t=new ci,n=new ci,r=new ci,i=new ci,a=new ci){this.planes=[e,t,n,r,i,a]}set(e,t,n,r,i,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(r),o[4].copy(i),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=vt,n=!1){let r=this.planes,i=e.elements,a=i[0],o=i[1],s=i[2],c=i[3],l=i[4],u=i[5],d=i[6],f=i[7],p=i[8],m=i[9],h=i[10],g=i[11],_=i[12],v=i[13],y=i[14],b=i[15];if(r[0].setComponents(c-a,f-l,g-p,b-_).normalize(),r[1].setComponents(c+a,f+l,g+p,b+_).normalize(),r[2].setComponents(c+o,f+u,g+m,b+v).normalize(),r[3].setComponents(c-o,f-u,g-m,b-v).normalize(),n)r[4].setComponents(s,d,h,y).normalize(),r[5].setComponents(c-s,f-d,g-h,b-y).normalize();else if(r[4].setComponents(c-s,f-d,g-h,b-y).normalize(),t===2e3)r[5].setComponents(c+s,f+d,g+h,b+y).normalize();else if(t===2001)r[5].setComponents(s,d,h,y).normalize();else throw Error(`THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: `+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Vi.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Vi.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Vi)}intersectsSprite(e){return Vi.center.set(0,0,0),Vi.radius=.7071067811865476+Hi.distanceTo(e.center),Vi.applyMatrix4(e.matrixWorld),this.intersectsSphere(Vi)}intersectsSphere(e){let t=this.planes,n=e.center,r=-e.radius;for(let e=0;e<6;e++)if(t[e].distanceToPoint(n)<r)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let r=t[n];if(Ui.x=r.normal.x>0?e.max.x:e.min.x,Ui.y=r.normal.y>0?e.max.y:e.min.y,Ui.z=r.normal.z>0?e.max.z:e.min.z,r.distanceToPoint(Ui)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Gi=new Y,Ki=class e{constructor(){this.coordinateSystem=vt,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let e=0;e<t.length;e++){let r=t[e];Gi.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[e]===void 0&&(n[e]=new Wi),n[e].setFromProjectionMatrix(Gi,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let r=0;r<e._count;r++)t[r]===void 0&&(t[r]=new Wi),t[r].copy(n[r]);return this._count=e._count,this}clone(){return new e().copy(this)}},qi=class extends ui{constructor(e){super(),this.isLineBasicMaterial=!0,this.type=`LineBasicMaterial`,this.color=new X(16777215),this.map=null,this.linewidth=1,this.linecap=`round`,this.linejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},Ji=new G,Yi=new G,Xi=new Y,Zi=new hi,Qi=new Kr,$i=new G,ea=new G,ta=class extends Zn{constructor(e=new ei,t=new qi){super(),this.isLine=!0,this.type=`Line`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let e=1,r=t.count;e<r;e++)Ji.fromBufferAttribute(t,e-1),Yi.fromBufferAttribute(t,e),n[e]=n[e-1],n[e]+=Ji.distanceTo(Yi);e.setAttribute(`lineDistance`,new Hr(n,1))}else V(`Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Line.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),Qi.copy(n.boundingSphere),Qi.applyMatrix4(r),Qi.radius+=i,e.ray.intersectsSphere(Qi)===!1)return;Xi.copy(r).invert(),Zi.copy(e.ray).applyMatrix4(Xi);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=this.isLineSegments?2:1,l=n.index,u=n.attributes.position;if(l!==null){let n=Math.max(0,a.start),r=Math.min(l.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=l.getX(i),r=l.getX(i+1),a=na(this,e,Zi,s,n,r,i);a&&t.push(a)}if(this.isLineLoop){let i=l.getX(r-1),a=l.getX(n),o=na(this,e,Zi,s,i,a,r-1);o&&t.push(o)}}else{let n=Math.max(0,a.start),r=Math.min(u.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=na(this,e,Zi,s,i,i+1,i);n&&t.push(n)}if(this.isLineLoop){let i=na(this,e,Zi,s,r-1,n,r-1);i&&t.push(i)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function na(e,t,n,r,i,a,o){let s=e.geometry.attributes.position;if(Ji.fromBufferAttribute(s,i),Yi.fromBufferAttribute(s,a),n.distanceSqToSegment(Ji,Yi,$i,ea)>r)return;$i.applyMatrix4(e.matrixWorld);let c=t.ray.origin.distanceTo($i);if(!(c<t.near||c>t.far))return{distance:c,point:ea.clone().applyMatrix4(e.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:e}}var ra=new G,ia=new G,aa=class extends ta{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type=`LineSegments`}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[];for(let e=0,r=t.count;e<r;e+=2)ra.fromBufferAttribute(t,e),ia.fromBufferAttribute(t,e+1),n[e]=e===0?0:n[e-1],n[e+1]=n[e]+ra.distanceTo(ia);e.setAttribute(`lineDistance`,new Hr(n,1))}else V(`LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}},oa=class extends ui{constructor(e){super(),this.isPointsMaterial=!0,this.type=`PointsMaterial`,this.color=new X(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},sa=new Y,ca=new hi,la=new Kr,ua=new G,da=class extends Zn{constructor(e=new ei,t=new oa){super(),this.isPoints=!0,this.type=`Points`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Points.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),la.copy(n.boundingSphere),la.applyMatrix4(r),la.radius+=i,e.ray.intersectsSphere(la)===!1)return;sa.copy(r).invert(),ca.copy(e.ray).applyMatrix4(sa);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=n.index,l=n.attributes.position;if(c!==null){let n=Math.max(0,a.start),i=Math.min(c.count,a.start+a.count);for(let a=n,o=i;a<o;a++){let n=c.getX(a);ua.fromBufferAttribute(l,n),fa(ua,n,s,r,e,t,this)}}else{let n=Math.max(0,a.start),i=Math.min(l.count,a.start+a.count);for(let a=n,o=i;a<o;a++)ua.fromBufferAttribute(l,a),fa(ua,a,s,r,e,t,this)}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function fa(e,t,n,r,i,a,o){let s=ca.distanceSqToPoint(e);if(s<n){let n=new G;ca.closestPointToPoint(e,n),n.applyMatrix4(r);let c=i.ray.origin.distanceTo(n);if(c<i.near||c>i.far)return;a.push({distance:c,distanceToRay:Math.sqrt(s),point:n,index:t,face:null,faceIndex:null,barycoord:null,object:o})}}var pa=class extends bn{constructor(e=[],t=301,n,r,i,a,o,s,c,l){super(e,t,n,r,i,a,o,s,c,l),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}},ma=class extends bn{constructor(e,t,n=F,r,i,a,o=N,s=N,c,l=ve,u=1){if(l!==1026&&l!==1027)throw Error(`THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat`);super({width:e,height:t,depth:u},r,i,a,o,s,l,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new gn(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},ha=class extends ma{constructor(e,t=F,n=301,r,i,a=N,o=N,s,c=ve){let l={width:e,height:e,depth:1},u=[l,l,l,l,l,l];super(e,e,t,n,r,i,a,o,s,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},ga=class extends bn{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},_a=class e extends ei{constructor(e=1,t=1,n=1,r=1,i=1,a=1){super(),this.type=`BoxGeometry`,this.parameters={width:e,height:t,depth:n,widthSegments:r,heightSegments:i,depthSegments:a};let o=this;r=Math.floor(r),i=Math.floor(i),a=Math.floor(a);let s=[],c=[],l=[],u=[],d=0,f=0;p(`z`,`y`,`x`,-1,-1,n,t,e,a,i,0),p(`z`,`y`,`x`,1,-1,n,t,-e,a,i,1),p(`x`,`z`,`y`,1,1,e,n,t,r,a,2),p(`x`,`z`,`y`,1,-1,e,n,-t,r,a,3),p(`x`,`y`,`z`,1,-1,e,t,n,r,i,4),p(`x`,`y`,`z`,-1,-1,e,t,-n,r,i,5),this.setIndex(s),this.setAttribute(`position`,new Hr(c,3)),this.setAttribute(`normal`,new Hr(l,3)),this.setAttribute(`uv`,new Hr(u,2));function p(e,t,n,r,i,a,p,m,h,g,_){let v=a/h,y=p/g,b=a/2,x=p/2,S=m/2,C=h+1,w=g+1,T=0,E=0,D=new G;for(let a=0;a<w;a++){let o=a*y-x;for(let s=0;s<C;s++)D[e]=(s*v-b)*r,D[t]=o*i,D[n]=S,c.push(D.x,D.y,D.z),D[e]=0,D[t]=0,D[n]=m>0?1:-1,l.push(D.x,D.y,D.z),u.push(s/h),u.push(1-a/g),T+=1}for(let e=0;e<g;e++)for(let t=0;t<h;t++){let n=d+t+C*e,r=d+t+C*(e+1),i=d+(t+1)+C*(e+1),a=d+(t+1)+C*e;s.push(n,r,a),s.push(r,i,a),E+=6}o.addGroup(f,E,_),f+=E,d+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},va=new G,ya=new G,ba=new G,xa=new br,Sa=class extends ei{constructor(e=null,t=1){if(super(),this.type=`EdgesGeometry`,this.parameters={geometry:e,thresholdAngle:t},e!==null){let n=1e4,r=Math.cos(Mt*t),i=e.getIndex(),a=e.getAttribute(`position`),o=i?i.count:a.count,s=[0,0,0],c=[`a`,`b`,`c`],l=[,,,],u=new Map,d=[];for(let e=0;e<o;e+=3){i?(s[0]=i.getX(e),s[1]=i.getX(e+1),s[2]=i.getX(e+2)):(s[0]=e,s[1]=e+1,s[2]=e+2);let{a:t,b:o,c:f}=xa;if(t.fromBufferAttribute(a,s[0]),o.fromBufferAttribute(a,s[1]),f.fromBufferAttribute(a,s[2]),xa.getNormal(ba),l[0]=`${Math.round(t.x*n)},${Math.round(t.y*n)},${Math.round(t.z*n)}`,l[1]=`${Math.round(o.x*n)},${Math.round(o.y*n)},${Math.round(o.z*n)}`,l[2]=`${Math.round(f.x*n)},${Math.round(f.y*n)},${Math.round(f.z*n)}`,l[0]!==l[1]&&l[1]!==l[2]&&l[2]!==l[0])for(let e=0;e<3;e++){let t=(e+1)%3,n=l[e],i=l[t],a=xa[c[e]],o=xa[c[t]],f=`${n}_${i}`,p=`${i}_${n}`,m=u.get(p);m?(ba.dot(m.normal)<=r&&(d.push(a.x,a.y,a.z),d.push(o.x,o.y,o.z)),u.set(p,null)):u.has(f)||u.set(f,{index0:s[e],index1:s[t],normal:ba.clone()})}}for(let e of u.values())if(e){let{index0:t,index1:n}=e;va.fromBufferAttribute(a,t),ya.fromBufferAttribute(a,n),d.push(va.x,va.y,va.z),d.push(ya.x,ya.y,ya.z)}this.setAttribute(`position`,new Hr(d,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}},Ca=class e extends ei{constructor(e=1,t=1,n=1,r=1){super(),this.type=`PlaneGeometry`,this.parameters={width:e,height:t,widthSegments:n,heightSegments:r};let i=e/2,a=t/2,o=Math.floor(n),s=Math.floor(r),c=o+1,l=s+1,u=e/o,d=t/s,f=[],p=[],m=[],h=[];for(let e=0;e<l;e++){let t=e*d-a;for(let n=0;n<c;n++){let r=n*u-i;p.push(r,-t,0),m.push(0,0,1),h.push(n/o),h.push(1-e/s)}}for(let e=0;e<s;e++)for(let t=0;t<o;t++){let n=t+c*e,r=t+c*(e+1),i=t+1+c*(e+1),a=t+1+c*e;f.push(n,r,a),f.push(r,i,a)}this.setIndex(f),this.setAttribute(`position`,new Hr(p,3)),this.setAttribute(`normal`,new Hr(m,3)),this.setAttribute(`uv`,new Hr(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.widthSegments,t.heightSegments)}},wa=class extends ei{constructor(e=null){if(super(),this.type=`WireframeGeometry`,this.parameters={geometry:e},e!==null){let t=[],n=new Set,r=new G,i=new G;if(e.index!==null){let a=e.attributes.position,o=e.index,s=e.groups;s.length===0&&(s=[{start:0,count:o.count,materialIndex:0}]);for(let e=0,c=s.length;e<c;++e){let c=s[e],l=c.start,u=c.count;for(let e=l,s=l+u;e<s;e+=3)for(let s=0;s<3;s++){let c=o.getX(e+s),l=o.getX(e+(s+1)%3);r.fromBufferAttribute(a,c),i.fromBufferAttribute(a,l),Ta(r,i,n)===!0&&(t.push(r.x,r.y,r.z),t.push(i.x,i.y,i.z))}}}else{let a=e.attributes.position;for(let e=0,o=a.count/3;e<o;e++)for(let o=0;o<3;o++){let s=3*e+o,c=3*e+(o+1)%3;r.fromBufferAttribute(a,s),i.fromBufferAttribute(a,c),Ta(r,i,n)===!0&&(t.push(r.x,r.y,r.z),t.push(i.x,i.y,i.z))}}this.setAttribute(`position`,new Hr(t,3))}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}};function Ta(e,t,n){let r=`${e.x},${e.y},${e.z}-${t.x},${t.y},${t.z}`,i=`${t.x},${t.y},${t.z}-${e.x},${e.y},${e.z}`;return n.has(r)===!0||n.has(i)===!0?!1:(n.add(r),n.add(i),!0)}function Ea(e){let t={};for(let n in e){t[n]={};for(let r in e[n]){let i=e[n][r];if(Oa(i))i.isRenderTargetTexture?(V(`UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms().`),t[n][r]=null):t[n][r]=i.clone();else if(Array.isArray(i)){if(Oa(i[0])){let e=[];for(let t=0,n=i.length;t<n;t++)e[t]=i[t].clone();t[n][r]=e}else t[n][r]=i.slice()}else t[n][r]=i}}return t}function Da(e){let t={};for(let n=0;n<e.length;n++){let r=Ea(e[n]);for(let e in r)t[e]=r[e]}return t}function Oa(e){return e&&(e.isColor||e.isMatrix3||e.isMatrix4||e.isVector2||e.isVector3||e.isVector4||e.isTexture||e.isQuaternion)}function ka(e){let t=[];for(let n=0;n<e.length;n++)t.push(e[n].clone());return t}function Aa(e){let t=e.getRenderTarget();return t===null?e.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:q.workingColorSpace}var ja={clone:Ea,merge:Da},Ma=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Na=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Pa=class extends ui{constructor(e){super(),this.isShaderMaterial=!0,this.type=`ShaderMaterial`,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Ma,this.fragmentShader=Na,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Ea(e.uniforms),this.uniformsGroups=ka(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let n in this.uniforms){let r=this.uniforms[n].value;r&&r.isTexture?t.uniforms[n]={type:`t`,value:r.toJSON(e).uuid}:r&&r.isColor?t.uniforms[n]={type:`c`,value:r.getHex()}:r&&r.isVector2?t.uniforms[n]={type:`v2`,value:r.toArray()}:r&&r.isVector3?t.uniforms[n]={type:`v3`,value:r.toArray()}:r&&r.isVector4?t.uniforms[n]={type:`v4`,value:r.toArray()}:r&&r.isMatrix3?t.uniforms[n]={type:`m3`,value:r.toArray()}:r&&r.isMatrix4?t.uniforms[n]={type:`m4`,value:r.toArray()}:t.uniforms[n]={value:r}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let e in this.extensions)this.extensions[e]===!0&&(n[e]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let r=e.uniforms[n];switch(this.uniforms[n]={},r.type){case`t`:this.uniforms[n].value=t[r.value]||null;break;case`c`:this.uniforms[n].value=new X().setHex(r.value);break;case`v2`:this.uniforms[n].value=new W().fromArray(r.value);break;case`v3`:this.uniforms[n].value=new G().fromArray(r.value);break;case`v4`:this.uniforms[n].value=new J().fromArray(r.value);break;case`m3`:this.uniforms[n].value=new K().fromArray(r.value);break;case`m4`:this.uniforms[n].value=new Y().fromArray(r.value);break;default:this.uniforms[n].value=r.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let t in e.extensions)this.extensions[t]=e.extensions[t];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Fa=class extends Pa{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type=`RawShaderMaterial`}},Ia=class extends ui{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type=`MeshDepthMaterial`,this.depthPacking=ut,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},La=class extends ui{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type=`MeshDistanceMaterial`,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function Ra(e,t){return!e||e.constructor===t?e:typeof t.BYTES_PER_ELEMENT==`number`?new t(e):Array.prototype.slice.call(e)}function za(e){return e!==void 0&&e.inTangents!==void 0&&e.outTangents!==void 0}var Ba=class{constructor(e,t,n,r){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=r===void 0?new t.constructor(n):r,this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,r=t[n],i=t[n-1];validate_interval:{seek:{let a;linear_scan:{forward_scan:if(!(e<r)){for(let a=n+2;;){if(r===void 0){if(e<i)break forward_scan;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(i=r,r=t[++n],e<r)break seek}a=t.length;break linear_scan}if(!(e>=i)){let o=t[1];e<o&&(n=2,i=o);for(let a=n-2;;){if(i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(r=i,i=t[--n-1],e>=i)break seek}a=n,n=0;break linear_scan}break validate_interval}for(;n<a;){let r=n+a>>>1;e<t[r]?a=r:n=r+1}if(r=t[n],i=t[n-1],i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(r===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,i,r)}return this.interpolate_(n,i,e,r)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r;for(let e=0;e!==r;++e)t[e]=n[i+e];return t}interpolate_(){throw Error(`THREE.Interpolant: Call to abstract method.`)}intervalChanged_(){}},Va=class extends Ba{constructor(e,t,n,r){super(e,t,n,r),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:st,endingEnd:st}}intervalChanged_(e,t,n){let r=this.parameterPositions,i=e-2,a=e+1,o=r[i],s=r[a];if(o===void 0)switch(this.getSettings_().endingStart){case ct:i=e,o=2*t-n;break;case lt:i=r.length-2,o=t+r[i]-r[i+1];break;default:i=e,o=n}if(s===void 0)switch(this.getSettings_().endingEnd){case ct:a=e,s=2*n-t;break;case lt:a=1,s=n+r[1]-r[0];break;default:a=e-1,s=t}let c=(n-t)*.5,l=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(s-n),this._offsetPrev=i*l,this._offsetNext=a*l}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,p=(n-t)/(r-t),m=p*p,h=m*p,g=-d*h+2*d*m-d*p,_=(1+d)*h+(-1.5-2*d)*m+(-.5+d)*p+1,v=(-1-f)*h+(1.5+f)*m+.5*p,y=f*h-f*m;for(let e=0;e!==o;++e)i[e]=g*a[l+e]+_*a[c+e]+v*a[s+e]+y*a[u+e];return i}},Ha=class extends Ba{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=(n-t)/(r-t),u=1-l;for(let e=0;e!==o;++e)i[e]=a[c+e]*u+a[s+e]*l;return i}},Ua=class extends Ba{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e){return this.copySampleValue_(e-1)}},Wa=class extends Ba{interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this.inTangents,u=this.outTangents;if(!l||!u){let e=(n-t)/(r-t),l=1-e;for(let t=0;t!==o;++t)i[t]=a[c+t]*l+a[s+t]*e;return i}let d=o*2,f=e-1;for(let p=0;p!==o;++p){let o=a[c+p],m=a[s+p],h=f*d+p*2,g=u[h],_=u[h+1],v=e*d+p*2,y=l[v],b=l[v+1],x=qa(n,t,g,y,r);i[p]=Ga(x,o,_,b,m)}return i}};function Ga(e,t,n,r,i){let a=1-e;return a*a*a*t+3*a*a*e*n+3*a*e*e*r+e*e*e*i}function Ka(e,t,n,r,i){let a=1-e;return 3*a*a*(n-t)+6*a*e*(r-n)+3*e*e*(i-r)}function qa(e,t,n,r,i){let a=(e-t)/(i-t);for(let o=0;o<8;o++){let o=Ga(a,t,n,r,i)-e;if(Math.abs(o)<1e-10)break;let s=Ka(a,t,n,r,i);if(Math.abs(s)<1e-10)break;a=Math.max(0,Math.min(1,a-o/s))}return a}var Ja=class{constructor(e,t,n,r){if(e===void 0)throw Error(`THREE.KeyframeTrack: track name is undefined`);if(t===void 0||t.length===0)throw Error(`THREE.KeyframeTrack: no keyframes in track named `+e);this.name=e,this.times=Ra(t,this.TimeBufferType),this.values=Ra(n,this.ValueBufferType),this.setInterpolation(r||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:Ra(e.times,Array),values:Ra(e.values,Array)};let t=e.getInterpolation();t!==e.DefaultInterpolation&&(n.interpolation=t),za(e.settings)&&(n.settings={inTangents:Ra(e.settings.inTangents,Array),outTangents:Ra(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Ua(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Ha(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new Va(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Wa(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case rt:t=this.InterpolantFactoryMethodDiscrete;break;case it:t=this.InterpolantFactoryMethodLinear;break;case at:t=this.InterpolantFactoryMethodSmooth;break;case ot:t=this.InterpolantFactoryMethodBezier}if(t===void 0){let t=`unsupported interpolation for `+this.ValueTypeName+` keyframe track named `+this.name;if(this.createInterpolant===void 0){if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw Error(t)}return V(`KeyframeTrack:`,t),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return rt;case this.InterpolantFactoryMethodLinear:return it;case this.InterpolantFactoryMethodSmooth:return at;case this.InterpolantFactoryMethodBezier:return ot}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]+=e;za(this.settings)&&(Ya(this.settings.inTangents,e),Ya(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]*=e;za(this.settings)&&(Xa(this.settings.inTangents,e),Xa(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,r=n.length,i=0,a=r-1;for(;i!==r&&n[i]<e;)++i;for(;a!==-1&&n[a]>t;)--a;if(++a,i!==0||a!==r){i>=a&&(a=Math.max(a,1),i=a-1);let e=this.getValueSize();this.times=n.slice(i,a),this.values=this.values.slice(i*e,a*e)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(H(`KeyframeTrack: Invalid value size in track.`,this),e=!1);let n=this.times,r=this.values,i=n.length;i===0&&(H(`KeyframeTrack: Track is empty.`,this),e=!1);let a=null;for(let t=0;t!==i;t++){let r=n[t];if(typeof r==`number`&&isNaN(r)){H(`KeyframeTrack: Time is not a valid number.`,this,t,r),e=!1;break}if(a!==null&&a>r){H(`KeyframeTrack: Out of order keys.`,this,t,r,a),e=!1;break}a=r}if(r!==void 0&&bt(r))for(let t=0,n=r.length;t!==n;++t){let n=r[t];if(isNaN(n)){H(`KeyframeTrack: Value is not a valid number.`,this,t,n),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),r=this.getInterpolation()===at,i=e.length-1,a=1;for(let o=1;o<i;++o){let i=!1,s=e[o];if(s!==e[o+1]&&(o!==1||s!==e[0])){if(r)i=!0;else{let e=o*n,r=e-n,a=e+n;for(let o=0;o!==n;++o){let n=t[e+o];if(n!==t[r+o]||n!==t[a+o]){i=!0;break}}}}if(i){if(o!==a){e[a]=e[o];let r=o*n,i=a*n;for(let e=0;e!==n;++e)t[i+e]=t[r+e]}++a}}if(i>0){e[a]=e[i];for(let e=i*n,r=a*n,o=0;o!==n;++o)t[r+o]=t[e+o];++a}return a===e.length?(this.times=e,this.values=t):(this.times=e.slice(0,a),this.values=t.slice(0,a*n)),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,r=new n(this.name,e,t);return r.createInterpolant=this.createInterpolant,za(this.settings)&&(r.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),r}};function Ya(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]+=t}function Xa(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]*=t}Ja.prototype.ValueTypeName=``,Ja.prototype.TimeBufferType=Float32Array,Ja.prototype.ValueBufferType=Float32Array,Ja.prototype.DefaultInterpolation=it;var Za=class extends Ja{constructor(e,t,n){super(e,t,n)}};Za.prototype.ValueTypeName=`bool`,Za.prototype.ValueBufferType=Array,Za.prototype.DefaultInterpolation=rt,Za.prototype.InterpolantFactoryMethodLinear=void 0,Za.prototype.InterpolantFactoryMethodSmooth=void 0;var Qa=class extends Ja{constructor(e,t,n,r){super(e,t,n,r)}};Qa.prototype.ValueTypeName=`color`;var $a=class extends Ja{constructor(e,t,n,r){super(e,t,n,r)}};$a.prototype.ValueTypeName=`number`;var eo=class extends Ba{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=(n-t)/(r-t),c=e*o;for(let e=c+o;c!==e;c+=4)rn.slerpFlat(i,0,a,c-o,a,c,s);return i}},to=class extends Ja{constructor(e,t,n,r){super(e,t,n,r)}InterpolantFactoryMethodLinear(e){return new eo(this.times,this.values,this.getValueSize(),e)}};to.prototype.ValueTypeName=`quaternion`,to.prototype.InterpolantFactoryMethodSmooth=void 0;var no=class extends Ja{constructor(e,t,n){super(e,t,n)}};no.prototype.ValueTypeName=`string`,no.prototype.ValueBufferType=Array,no.prototype.DefaultInterpolation=rt,no.prototype.InterpolantFactoryMethodLinear=void 0,no.prototype.InterpolantFactoryMethodSmooth=void 0;var ro=class extends Ja{constructor(e,t,n,r){super(e,t,n,r)}};ro.prototype.ValueTypeName=`vector`;var io=new G,ao=new rn,oo=new G,so=class extends Zn{constructor(){super(),this.isCamera=!0,this.type=`Camera`,this.matrixWorldInverse=new Y,this.projectionMatrix=new Y,this.projectionMatrixInverse=new Y,this.coordinateSystem=vt,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(io,ao,oo),oo.x===1&&oo.y===1&&oo.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(io,ao,oo.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(io,ao,oo),oo.x===1&&oo.y===1&&oo.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(io,ao,oo.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},co=new G,lo=new W,uo=new W,fo=class extends so{constructor(e=50,t=1,n=.1,r=2e3){super(),this.isPerspectiveCamera=!0,this.type=`PerspectiveCamera`,this.fov=e,this.zoom=1,this.near=n,this.far=r,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=Nt*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Mt*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return Nt*2*Math.atan(Math.tan(Mt*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){co.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(co.x,co.y).multiplyScalar(-e/co.z),co.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(co.x,co.y).multiplyScalar(-e/co.z)}getViewSize(e,t){return this.getViewBounds(e,lo,uo),t.subVectors(uo,lo)}setViewOffset(e,t,n,r,i,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Mt*.5*this.fov)/this.zoom,n=2*t,r=this.aspect*n,i=-.5*r,a=this.view;if(this.view!==null&&this.view.enabled){let e=a.fullWidth,o=a.fullHeight;i+=a.offsetX*r/e,t-=a.offsetY*n/o,r*=a.width/e,n*=a.height/o}let o=this.filmOffset;o!==0&&(i+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(i,i+r,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}},po=class extends so{constructor(e=-1,t=1,n=1,r=-1,i=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type=`OrthographicCamera`,this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=r,this.near=i,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,r,i,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,r=(this.top+this.bottom)/2,i=n-e,a=n+e,o=r+t,s=r-t;if(this.view!==null&&this.view.enabled){let e=(this.right-this.left)/this.view.fullWidth/this.zoom,t=(this.top-this.bottom)/this.view.fullHeight/this.zoom;i+=e*this.view.offsetX,a=i+e*this.view.width,o-=t*this.view.offsetY,s=o-t*this.view.height}this.projectionMatrix.makeOrthographic(i,a,o,s,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},mo=class extends ei{constructor(){super(),this.isInstancedBufferGeometry=!0,this.type=`InstancedBufferGeometry`,this.instanceCount=1/0}copy(e){return super.copy(e),this.instanceCount=e.instanceCount,this}toJSON(){let e=super.toJSON();return e.instanceCount=this.instanceCount,e.isInstancedBufferGeometry=!0,e}},ho=-90,go=1,_o=class extends Zn{constructor(e,t,n){super(),this.type=`CubeCamera`,this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let r=new fo(ho,go,e,t);r.layers=this.layers,this.add(r);let i=new fo(ho,go,e,t);i.layers=this.layers,this.add(i);let a=new fo(ho,go,e,t);a.layers=this.layers,this.add(a);let o=new fo(ho,go,e,t);o.layers=this.layers,this.add(o);let s=new fo(ho,go,e,t);s.layers=this.layers,this.add(s);let c=new fo(ho,go,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,r,i,a,o,s]=t;for(let e of t)this.remove(e);if(e===2e3)n.up.set(0,1,0),n.lookAt(1,0,0),r.up.set(0,1,0),r.lookAt(-1,0,0),i.up.set(0,0,-1),i.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),s.up.set(0,1,0),s.lookAt(0,0,-1);else if(e===2001)n.up.set(0,-1,0),n.lookAt(-1,0,0),r.up.set(0,-1,0),r.lookAt(1,0,0),i.up.set(0,0,1),i.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),s.up.set(0,-1,0),s.lookAt(0,0,-1);else throw Error(`THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: `+e);for(let e of t)this.add(e),e.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:r}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[i,a,o,s,c,l]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),p=e.xr.enabled;e.xr.enabled=!1;let m=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let h=!1;h=e.isWebGLRenderer===!0?e.state.buffers.depth.getReversed():e.reversedDepthBuffer,e.setRenderTarget(n,0,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,i),e.setRenderTarget(n,1,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,s),e.setRenderTarget(n,4,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=m,e.setRenderTarget(n,5,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(u,d,f),e.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},vo=class extends fo{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}},yo=`\\[\\]\\.:\\/`,bo=RegExp(`[\\[\\]\\.:\\/]`,`g`),xo=`[^\\[\\]\\.:\\/]`,So=`[^`+yo.replace(`\\.`,``)+`]`,Co=`((?:WC+[\\/:])*)`.replace(`WC`,xo),wo=`(WCOD+)?`.replace(`WCOD`,So),To=`(?:\\.(WC+)(?:\\[(.+)\\])?)?`.replace(`WC`,xo),Eo=`\\.(WC+)(?:\\[(.+)\\])?`.replace(`WC`,xo),Do=RegExp(`^`+Co+wo+To+Eo+`$`),Oo=[`material`,`materials`,`bones`,`map`],ko=class{constructor(e,t,n){let r=n||Ao.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,r)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,r=this._bindings[n];r!==void 0&&r.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let r=this._targetGroup.nCachedObjects_,i=n.length;r!==i;++r)n[r].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},Ao=class e{constructor(t,n,r){this.path=n,this.parsedPath=r||e.parseTrackName(n),this.node=e.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,n,r){return t&&t.isAnimationObjectGroup?new e.Composite(t,n,r):new e(t,n,r)}static sanitizeNodeName(e){return e.replace(/\s/g,`_`).replace(bo,``)}static parseTrackName(e){let t=Do.exec(e);if(t===null)throw Error(`THREE.PropertyBinding: Cannot parse trackName: `+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},r=n.nodeName&&n.nodeName.lastIndexOf(`.`);if(r!==void 0&&r!==-1){let e=n.nodeName.substring(r+1);Oo.indexOf(e)!==-1&&(n.nodeName=n.nodeName.substring(0,r),n.objectName=e)}if(n.propertyName===null||n.propertyName.length===0)throw Error(`THREE.PropertyBinding: can not parse propertyName from trackName: `+e);return n}static findNode(e,t){if(t===void 0||t===``||t===`.`||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(e){for(let r=0;r<e.length;r++){let i=e[r];if(i.name===t||i.uuid===t)return i;let a=n(i.children);if(a)return a}return null},r=n(e.children);if(r)return r}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)e[t++]=n[r]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let t=this.node,n=this.parsedPath,r=n.objectName,i=n.propertyName,a=n.propertyIndex;if(t||(t=e.findNode(this.rootNode,n.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){V(`PropertyBinding: No target node found for track: `+this.path+`.`);return}if(r){let e=n.objectIndex;switch(r){case`materials`:if(!t.material){H(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.materials){H(`PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.`,this);return}t=t.material.materials;break;case`bones`:if(!t.skeleton){H(`PropertyBinding: Can not bind to bones as node does not have a skeleton.`,this);return}t=t.skeleton.bones;for(let n=0;n<t.length;n++)if(t[n].name===e){e=n;break}break;case`map`:if(`map`in t){t=t.map;break}if(!t.material){H(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.map){H(`PropertyBinding: Can not bind to material.map as node.material does not have a map.`,this);return}t=t.material.map;break;default:if(t[r]===void 0){H(`PropertyBinding: Can not bind to objectName of node undefined.`,this);return}t=t[r]}if(e!==void 0){if(t[e]===void 0){H(`PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.`,this,t);return}t=t[e]}}let o=t[i];if(o===void 0){let e=n.nodeName;H(`PropertyBinding: Trying to update property for track: `+e+`.`+i+` but it wasn't found.`,t);return}let s=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?s=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(s=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(a!==void 0){if(i===`morphTargetInfluences`){if(!t.geometry){H(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.`,this);return}if(!t.geometry.morphAttributes){H(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.`,this);return}t.morphTargetDictionary[a]!==void 0&&(a=t.morphTargetDictionary[a])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=a}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=i;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][s]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};Ao.Composite=ko,Ao.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3},Ao.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2},Ao.prototype.GetterByBindingType=[Ao.prototype._getValue_direct,Ao.prototype._getValue_array,Ao.prototype._getValue_arrayElement,Ao.prototype._getValue_toArray],Ao.prototype.SetterByBindingTypeAndVersioning=[[Ao.prototype._setValue_direct,Ao.prototype._setValue_direct_setNeedsUpdate,Ao.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[Ao.prototype._setValue_array,Ao.prototype._setValue_array_setNeedsUpdate,Ao.prototype._setValue_array_setMatrixWorldNeedsUpdate],[Ao.prototype._setValue_arrayElement,Ao.prototype._setValue_arrayElement_setNeedsUpdate,Ao.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[Ao.prototype._setValue_fromArray,Ao.prototype._setValue_fromArray_setNeedsUpdate,Ao.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var jo=class extends ti{constructor(e,t,n=1){super(e,t),this.isInstancedInterleavedBuffer=!0,this.meshPerAttribute=n}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}clone(e){let t=super.clone(e);return t.meshPerAttribute=this.meshPerAttribute,t}toJSON(e){let t=super.toJSON(e);return t.isInstancedInterleavedBuffer=!0,t.meshPerAttribute=this.meshPerAttribute,t}};(class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,r){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,r)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,r){let i=this.elements;return i[0]=e,i[2]=t,i[1]=n,i[3]=r,this}});var Mo=new G,No=new G,Po=new G,Fo=new G,Io=new G,Lo=new G,Ro=new G,zo=class{constructor(e=new G,t=new G){this.start=e,this.end=t}set(e,t){return this.start.copy(e),this.end.copy(t),this}copy(e){return this.start.copy(e.start),this.end.copy(e.end),this}getCenter(e){return e.addVectors(this.start,this.end).multiplyScalar(.5)}delta(e){return e.subVectors(this.end,this.start)}distanceSq(){return this.start.distanceToSquared(this.end)}distance(){return this.start.distanceTo(this.end)}at(e,t){return this.delta(t).multiplyScalar(e).add(this.start)}closestPointToPointParameter(e,t){Mo.subVectors(e,this.start),No.subVectors(this.end,this.start);let n=No.dot(No);if(n===0)return 0;let r=No.dot(Mo)/n;return t&&(r=U(r,0,1)),r}closestPointToPoint(e,t,n){let r=this.closestPointToPointParameter(e,t);return this.delta(n).multiplyScalar(r).add(this.start)}distanceSqToLine3(e,t=Lo,n=Ro){let r=1e-8*1e-8,i,a,o=this.start,s=e.start,c=this.end,l=e.end;Po.subVectors(c,o),Fo.subVectors(l,s),Io.subVectors(o,s);let u=Po.dot(Po),d=Fo.dot(Fo),f=Fo.dot(Io);if(u<=r&&d<=r)return t.copy(o),n.copy(s),t.distanceToSquared(n);if(u<=r)i=0,a=f/d,a=U(a,0,1);else{let e=Po.dot(Io);if(d<=r)a=0,i=U(-e/u,0,1);else{let t=Po.dot(Fo),n=u*d-t*t;i=n===0?0:U((t*f-e*d)/n,0,1),a=(t*i+f)/d,a<0?(a=0,i=U(-e/u,0,1)):a>1&&(a=1,i=U((t-e)/u,0,1))}}return t.copy(o).addScaledVector(Po,i),n.copy(s).addScaledVector(Fo,a),t.distanceToSquared(n)}applyMatrix4(e){return this.start.applyMatrix4(e),this.end.applyMatrix4(e),this}equals(e){return e.start.equals(this.start)&&e.end.equals(this.end)}clone(){return new this.constructor().copy(this)}};function Bo(e,t,n,r){let i=Vo(r);switch(n){case he:return e*t;case be:return e*t/i.components*i.byteLength;case xe:return e*t/i.components*i.byteLength;case Se:return e*t*2/i.components*i.byteLength;case Ce:return e*t*2/i.components*i.byteLength;case ge:return e*t*3/i.components*i.byteLength;case _e:return e*t*4/i.components*i.byteLength;case we:return e*t*4/i.components*i.byteLength;case Te:case Ee:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case De:case Oe:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Ae:case Me:return Math.max(e,16)*Math.max(t,8)/4;case ke:case je:return Math.max(e,8)*Math.max(t,8)/2;case L:case Ne:case Fe:case R:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case Pe:case Ie:case z:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case B:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Le:return Math.floor((e+4)/5)*Math.floor((t+3)/4)*16;case Re:return Math.floor((e+4)/5)*Math.floor((t+4)/5)*16;case ze:return Math.floor((e+5)/6)*Math.floor((t+4)/5)*16;case Be:return Math.floor((e+5)/6)*Math.floor((t+5)/6)*16;case Ve:return Math.floor((e+7)/8)*Math.floor((t+4)/5)*16;case He:return Math.floor((e+7)/8)*Math.floor((t+5)/6)*16;case Ue:return Math.floor((e+7)/8)*Math.floor((t+7)/8)*16;case We:return Math.floor((e+9)/10)*Math.floor((t+4)/5)*16;case Ge:return Math.floor((e+9)/10)*Math.floor((t+5)/6)*16;case Ke:return Math.floor((e+9)/10)*Math.floor((t+7)/8)*16;case qe:return Math.floor((e+9)/10)*Math.floor((t+9)/10)*16;case Je:return Math.floor((e+11)/12)*Math.floor((t+9)/10)*16;case Ye:return Math.floor((e+11)/12)*Math.floor((t+11)/12)*16;case Xe:case Ze:case Qe:return Math.ceil(e/4)*Math.ceil(t/4)*16;case $e:case et:return Math.ceil(e/4)*Math.ceil(t/4)*8;case tt:case nt:return Math.ceil(e/4)*Math.ceil(t/4)*16}throw Error(`Unable to determine texture byte length for ${n} format.`)}function Vo(e){switch(e){case ie:case ae:return{byteLength:1,components:1};case se:case oe:case le:return{byteLength:2,components:1};case ue:case de:return{byteLength:2,components:4};case F:case ce:case I:return{byteLength:4,components:1};case pe:case me:return{byteLength:4,components:3}}throw Error(`THREE.TextureUtils: Unknown texture type ${e}.`)}typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`register`,{detail:{revision:`187`}})),typeof window<`u`&&(window.__THREE__?V(`WARNING: Multiple instances of Three.js being imported.`):window.__THREE__=`187`);function Ho(){let e=null,t=!1,n=null,r=null;function i(t,a){r=e.requestAnimationFrame(i),n(t,a)}return{start:function(){t!==!0&&n!==null&&e!==null&&(r=e.requestAnimationFrame(i),t=!0)},stop:function(){e!==null&&e.cancelAnimationFrame(r),t=!1},setAnimationLoop:function(e){n=e},setContext:function(t){e=t}}}function Uo(e){let t=new WeakMap;function n(t,n){let r=t.array,i=t.usage,a=r.byteLength,o=e.createBuffer();e.bindBuffer(n,o),e.bufferData(n,r,i),t.onUploadCallback();let s;if(r instanceof Float32Array)s=e.FLOAT;else if(typeof Float16Array<`u`&&r instanceof Float16Array)s=e.HALF_FLOAT;else if(r instanceof Uint16Array)s=t.isFloat16BufferAttribute?e.HALF_FLOAT:e.UNSIGNED_SHORT;else if(r instanceof Int16Array)s=e.SHORT;else if(r instanceof Uint32Array)s=e.UNSIGNED_INT;else if(r instanceof Int32Array)s=e.INT;else if(r instanceof Int8Array)s=e.BYTE;else if(r instanceof Uint8Array)s=e.UNSIGNED_BYTE;else if(r instanceof Uint8ClampedArray)s=e.UNSIGNED_BYTE;else throw Error(`THREE.WebGLAttributes: Unsupported buffer data format: `+r);return{buffer:o,type:s,bytesPerElement:r.BYTES_PER_ELEMENT,version:t.version,size:a}}function r(t,n,r){let i=n.array,a=n.updateRanges;if(e.bindBuffer(r,t),a.length===0)e.bufferSubData(r,0,i);else{a.sort((e,t)=>e.start-t.start);let t=0;for(let e=1;e<a.length;e++){let n=a[t],r=a[e];r.start<=n.start+n.count+1?n.count=Math.max(n.count,r.start+r.count-n.start):(++t,a[t]=r)}a.length=t+1;for(let t=0,n=a.length;t<n;t++){let n=a[t];e.bufferSubData(r,n.start*i.BYTES_PER_ELEMENT,i,n.start,n.count)}n.clearUpdateRanges()}n.onUploadCallback()}function i(e){return e.isInterleavedBufferAttribute&&(e=e.data),t.get(e)}function a(n){n.isInterleavedBufferAttribute&&(n=n.data);let r=t.get(n);r&&(e.deleteBuffer(r.buffer),t.delete(n))}function o(e,i){if(e.isInterleavedBufferAttribute&&(e=e.data),e.isGLBufferAttribute){let n=t.get(e);(!n||n.version<e.version)&&t.set(e,{buffer:e.buffer,type:e.type,bytesPerElement:e.elementSize,version:e.version});return}let a=t.get(e);if(a===void 0)t.set(e,n(e,i));else if(a.version<e.version){if(a.size!==e.array.byteLength)throw Error(`THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.`);r(a.buffer,e,i),a.version=e.version}}return{get:i,remove:a,update:o}}var Z={alphahash_fragment:`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,alphahash_pars_fragment:`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,alphamap_fragment:`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,alphamap_pars_fragment:`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,alphatest_fragment:`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,alphatest_pars_fragment:`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,aomap_fragment:`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,aomap_pars_fragment:`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,batching_pars_vertex:`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,batching_vertex:`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,begin_vertex:`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,beginnormal_vertex:`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,bsdfs:`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,iridescence_fragment:`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,bumpmap_pars_fragment:`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,clipping_planes_fragment:`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,clipping_planes_pars_fragment:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,clipping_planes_pars_vertex:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,clipping_planes_vertex:`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,color_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,color_pars_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,color_pars_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,color_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,common:`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,defaultnormal_vertex:`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,displacementmap_pars_vertex:`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,displacementmap_vertex:`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,emissivemap_fragment:`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,emissivemap_pars_fragment:`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,colorspace_fragment:`gl_FragColor = linearToOutputTexel( gl_FragColor );`,colorspace_pars_fragment:`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,envmap_fragment:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,envmap_common_pars_fragment:`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,envmap_pars_fragment:`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,envmap_pars_vertex:`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,envmap_physical_pars_fragment:`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,envmap_vertex:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,fog_vertex:`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,fog_pars_vertex:`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,fog_fragment:`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,fog_pars_fragment:`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,gradientmap_pars_fragment:`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,lightmap_pars_fragment:`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,lights_lambert_fragment:`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,lights_lambert_pars_fragment:`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,lights_pars_begin:`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,lights_toon_fragment:`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,lights_toon_pars_fragment:`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,lights_phong_fragment:`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,lights_phong_pars_fragment:`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,lights_physical_fragment:`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,lights_physical_pars_fragment:`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,lights_fragment_begin:`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,lights_fragment_maps:`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,lights_fragment_end:`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,lightprobes_pars_fragment:`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,logdepthbuf_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,logdepthbuf_pars_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_pars_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,map_fragment:`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,map_pars_fragment:`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,map_particle_fragment:`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,map_particle_pars_fragment:`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,metalnessmap_fragment:`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,metalnessmap_pars_fragment:`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,morphinstance_vertex:`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,morphcolor_vertex:`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,morphnormal_vertex:`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,morphtarget_pars_vertex:`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,morphtarget_vertex:`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,normal_fragment_begin:`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,normal_fragment_maps:`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,normal_pars_fragment:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_pars_vertex:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_vertex:`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,normalmap_pars_fragment:`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,clearcoat_normal_fragment_begin:`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,clearcoat_normal_fragment_maps:`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,clearcoat_pars_fragment:`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iridescence_pars_fragment:`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,opaque_fragment:`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,packing:`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,premultiplied_alpha_fragment:`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,project_vertex:`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,dithering_fragment:`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,dithering_pars_fragment:`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,roughnessmap_fragment:`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,roughnessmap_pars_fragment:`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,shadowmap_pars_fragment:`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,shadowmap_pars_vertex:`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,shadowmap_vertex:`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,shadowmask_pars_fragment:`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,skinbase_vertex:`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,skinning_pars_vertex:`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,skinning_vertex:`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,skinnormal_vertex:`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,specularmap_fragment:`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,specularmap_pars_fragment:`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,tonemapping_fragment:`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,tonemapping_pars_fragment:`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,transmission_fragment:`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,transmission_pars_fragment:`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,uv_pars_fragment:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_pars_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,worldpos_vertex:`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,background_vert:`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,background_frag:`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,backgroundCube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,backgroundCube_frag:`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,cube_frag:`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,depth_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,depth_frag:`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,distance_vert:`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,distance_frag:`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,equirect_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,equirect_frag:`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,linedashed_vert:`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,linedashed_frag:`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,meshbasic_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,meshbasic_frag:`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshlambert_vert:`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshlambert_frag:`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshmatcap_vert:`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,meshmatcap_frag:`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshnormal_vert:`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,meshnormal_frag:`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,meshphong_vert:`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshphong_frag:`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshphysical_vert:`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,meshphysical_frag:`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshtoon_vert:`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshtoon_frag:`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,points_vert:`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,points_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,shadow_vert:`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,shadow_frag:`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,sprite_vert:`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,sprite_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`},Q={common:{diffuse:{value:new X(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new K},alphaMap:{value:null},alphaMapTransform:{value:new K},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new K}},envmap:{envMap:{value:null},envMapRotation:{value:new K},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new K}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new K}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new K},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new K},normalScale:{value:new W(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new K},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new K}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new K}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new K}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new X(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new X(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new K},alphaTest:{value:0},uvTransform:{value:new K}},sprite:{diffuse:{value:new X(16777215)},opacity:{value:1},center:{value:new W(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new K},alphaMap:{value:null},alphaMapTransform:{value:new K},alphaTest:{value:0}}},Wo={basic:{uniforms:Da([Q.common,Q.specularmap,Q.envmap,Q.aomap,Q.lightmap,Q.fog]),vertexShader:Z.meshbasic_vert,fragmentShader:Z.meshbasic_frag},lambert:{uniforms:Da([Q.common,Q.specularmap,Q.envmap,Q.aomap,Q.lightmap,Q.emissivemap,Q.bumpmap,Q.normalmap,Q.displacementmap,Q.fog,Q.lights,{emissive:{value:new X(0)},envMapIntensity:{value:1}}]),vertexShader:Z.meshlambert_vert,fragmentShader:Z.meshlambert_frag},phong:{uniforms:Da([Q.common,Q.specularmap,Q.envmap,Q.aomap,Q.lightmap,Q.emissivemap,Q.bumpmap,Q.normalmap,Q.displacementmap,Q.fog,Q.lights,{emissive:{value:new X(0)},specular:{value:new X(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:Z.meshphong_vert,fragmentShader:Z.meshphong_frag},standard:{uniforms:Da([Q.common,Q.envmap,Q.aomap,Q.lightmap,Q.emissivemap,Q.bumpmap,Q.normalmap,Q.displacementmap,Q.roughnessmap,Q.metalnessmap,Q.fog,Q.lights,{emissive:{value:new X(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:Z.meshphysical_vert,fragmentShader:Z.meshphysical_frag},toon:{uniforms:Da([Q.common,Q.aomap,Q.lightmap,Q.emissivemap,Q.bumpmap,Q.normalmap,Q.displacementmap,Q.gradientmap,Q.fog,Q.lights,{emissive:{value:new X(0)}}]),vertexShader:Z.meshtoon_vert,fragmentShader:Z.meshtoon_frag},matcap:{uniforms:Da([Q.common,Q.bumpmap,Q.normalmap,Q.displacementmap,Q.fog,{matcap:{value:null}}]),vertexShader:Z.meshmatcap_vert,fragmentShader:Z.meshmatcap_frag},points:{uniforms:Da([Q.points,Q.fog]),vertexShader:Z.points_vert,fragmentShader:Z.points_frag},dashed:{uniforms:Da([Q.common,Q.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:Z.linedashed_vert,fragmentShader:Z.linedashed_frag},depth:{uniforms:Da([Q.common,Q.displacementmap]),vertexShader:Z.depth_vert,fragmentShader:Z.depth_frag},normal:{uniforms:Da([Q.common,Q.bumpmap,Q.normalmap,Q.displacementmap,{opacity:{value:1}}]),vertexShader:Z.meshnormal_vert,fragmentShader:Z.meshnormal_frag},sprite:{uniforms:Da([Q.sprite,Q.fog]),vertexShader:Z.sprite_vert,fragmentShader:Z.sprite_frag},background:{uniforms:{uvTransform:{value:new K},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:Z.background_vert,fragmentShader:Z.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new K}},vertexShader:Z.backgroundCube_vert,fragmentShader:Z.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:Z.cube_vert,fragmentShader:Z.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:Z.equirect_vert,fragmentShader:Z.equirect_frag},distance:{uniforms:Da([Q.common,Q.displacementmap,{referencePosition:{value:new G},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:Z.distance_vert,fragmentShader:Z.distance_frag},shadow:{uniforms:Da([Q.lights,Q.fog,{color:{value:new X(0)},opacity:{value:1}}]),vertexShader:Z.shadow_vert,fragmentShader:Z.shadow_frag}};Wo.physical={uniforms:Da([Wo.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new K},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new K},clearcoatNormalScale:{value:new W(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new K},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new K},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new K},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new K},sheen:{value:0},sheenColor:{value:new X(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new K},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new K},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new K},transmissionSamplerSize:{value:new W},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new K},attenuationDistance:{value:0},attenuationColor:{value:new X(0)},specularColor:{value:new X(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new K},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new K},anisotropyVector:{value:new W},anisotropyMap:{value:null},anisotropyMapTransform:{value:new K}}]),vertexShader:Z.meshphysical_vert,fragmentShader:Z.meshphysical_frag};var Go={r:0,b:0,g:0},Ko=new Y,qo=new K;qo.set(-1,0,0,0,1,0,0,0,1);function Jo(e,t,n,r,i,a){let o=new X(0),s=i===!0?0:1,c,l,u=null,d=0,f=null;function p(e){let n=e.isScene===!0?e.background:null;if(n&&n.isTexture){let r=e.backgroundBlurriness>0;n=t.get(n,r)}return n}function m(t){let r=!1,i=p(t);i===null?g(o,s):i&&i.isColor&&(g(i,1),r=!0);let c=e.xr.getEnvironmentBlendMode();c===`additive`?n.buffers.color.setClear(0,0,0,1,a):c===`alpha-blend`&&n.buffers.color.setClear(0,0,0,0,a),(e.autoClear||r)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),e.clear(e.autoClearColor,e.autoClearDepth,e.autoClearStencil))}function h(t,n){let i=p(n);i&&i.isCubeTexture?(l===void 0&&(l=new Oi(new _a(1,1,1),new Pa({name:`BackgroundCubeMaterial`,uniforms:Ea(Wo.backgroundCube.uniforms),vertexShader:Wo.backgroundCube.vertexShader,fragmentShader:Wo.backgroundCube.fragmentShader,side:1,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute(`normal`),l.geometry.deleteAttribute(`uv`),l.onBeforeRender=function(e,t,n){this.matrixWorld.copyPosition(n.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),r.update(l)),l.material.uniforms.envMap.value=i,l.material.uniforms.backgroundBlurriness.value=n.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(Ko.makeRotationFromEuler(n.backgroundRotation)).transpose(),i.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(qo),l.material.toneMapped=q.getTransfer(i.colorSpace)!==mt,(u!==i||d!==i.version||f!==e.toneMapping)&&(l.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),l.layers.enableAll(),t.unshift(l,l.geometry,l.material,0,0,null)):i&&i.isTexture&&(c===void 0&&(c=new Oi(new Ca(2,2),new Pa({name:`BackgroundMaterial`,uniforms:Ea(Wo.background.uniforms),vertexShader:Wo.background.vertexShader,fragmentShader:Wo.background.fragmentShader,side:0,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute(`normal`),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),r.update(c)),c.material.uniforms.t2D.value=i,c.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,c.material.toneMapped=q.getTransfer(i.colorSpace)!==mt,i.matrixAutoUpdate===!0&&i.updateMatrix(),c.material.uniforms.uvTransform.value.copy(i.matrix),(u!==i||d!==i.version||f!==e.toneMapping)&&(c.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),c.layers.enableAll(),t.unshift(c,c.geometry,c.material,0,0,null))}function g(t,r){t.getRGB(Go,Aa(e)),n.buffers.color.setClear(Go.r,Go.g,Go.b,r,a)}function _(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(e,t=1){o.set(e),s=t,g(o,s)},getClearAlpha:function(){return s},setClearAlpha:function(e){s=e,g(o,s)},render:m,addToRenderList:h,dispose:_}}function Yo(e,t){let n=e.getParameter(e.MAX_VERTEX_ATTRIBS),r={},i=f(null),a=i,o=!1;function s(n,r,i,s,c){let u=!1,f=d(n,s,i,r);a!==f&&(a=f,l(a.object)),u=p(n,s,i,c),u&&m(n,s,i,c),c!==null&&t.update(c,e.ELEMENT_ARRAY_BUFFER),(u||o)&&(o=!1,b(n,r,i,s),c!==null&&e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,t.get(c).buffer))}function c(){return e.createVertexArray()}function l(t){return e.bindVertexArray(t)}function u(t){return e.deleteVertexArray(t)}function d(e,t,n,i){let a=i.wireframe===!0,o=r[t.id];o===void 0&&(o={},r[t.id]=o);let s=e.isInstancedMesh===!0?e.id:0,l=o[s];l===void 0&&(l={},o[s]=l);let u=l[n.id];u===void 0&&(u={},l[n.id]=u);let d=u[a];return d===void 0&&(d=f(c()),u[a]=d),d}function f(e){let t=[],r=[],i=[];for(let e=0;e<n;e++)t[e]=0,r[e]=0,i[e]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:t,enabledAttributes:r,attributeDivisors:i,object:e,attributes:{},index:null}}function p(e,t,n,r){let i=a.attributes,o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=i[t],r=o[t];if(r===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(r=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(r=e.instanceColor)),n===void 0||n.attribute!==r||r&&n.data!==r.data)return!0;s++}return a.attributesNum!==s||a.index!==r}function m(e,t,n,r){let i={},o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=o[t];n===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(n=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(n=e.instanceColor));let r={};r.attribute=n,n&&n.data&&(r.data=n.data),i[t]=r,s++}a.attributes=i,a.attributesNum=s,a.index=r}function h(){let e=a.newAttributes;for(let t=0,n=e.length;t<n;t++)e[t]=0}function g(e){_(e,0)}function _(t,n){let r=a.newAttributes,i=a.enabledAttributes,o=a.attributeDivisors;r[t]=1,i[t]===0&&(e.enableVertexAttribArray(t),i[t]=1),o[t]!==n&&(e.vertexAttribDivisor(t,n),o[t]=n)}function v(){let t=a.newAttributes,n=a.enabledAttributes;for(let r=0,i=n.length;r<i;r++)n[r]!==t[r]&&(e.disableVertexAttribArray(r),n[r]=0)}function y(t,n,r,i,a,o,s){s===!0?e.vertexAttribIPointer(t,n,r,a,o):e.vertexAttribPointer(t,n,r,i,a,o)}function b(n,r,i,a){h();let o=a.attributes,s=i.getAttributes(),c=r.defaultAttributeValues;for(let r in s){let i=s[r];if(i.location>=0){let s=o[r];if(s===void 0&&(r===`instanceMatrix`&&n.instanceMatrix&&(s=n.instanceMatrix),r===`instanceColor`&&n.instanceColor&&(s=n.instanceColor)),s!==void 0){let r=s.normalized,o=s.itemSize,c=t.get(s);if(c===void 0)continue;let l=c.buffer,u=c.type,d=c.bytesPerElement,f=u===e.INT||u===e.UNSIGNED_INT||s.gpuType===1013;if(s.isInterleavedBufferAttribute){let t=s.data,c=t.isInterleavedBuffer===!0?t.stride:t.itemSize,p=s.offset;if(t.isInstancedInterleavedBuffer||t.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,t.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=t.meshPerAttribute*t.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,c*d,(p+o/i.locationSize*e)*d,f)}else{if(s.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,s.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=s.meshPerAttribute*s.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,o*d,o/i.locationSize*e*d,f)}}else if(c!==void 0){let t=c[r];if(t!==void 0)switch(t.length){case 2:e.vertexAttrib2fv(i.location,t);break;case 3:e.vertexAttrib3fv(i.location,t);break;case 4:e.vertexAttrib4fv(i.location,t);break;default:e.vertexAttrib1fv(i.location,t)}}}}v()}function x(){T();for(let e in r){let t=r[e];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e]}}function S(e){if(r[e.id]===void 0)return;let t=r[e.id];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e.id]}function C(e){for(let t in r){let n=r[t];for(let t in n){let r=n[t];if(r[e.id]===void 0)continue;let i=r[e.id];for(let e in i)u(i[e].object),delete i[e];delete r[e.id]}}}function w(e){for(let t in r){let n=r[t],i=e.isInstancedMesh===!0?e.id:0,a=n[i];if(a!==void 0){for(let e in a){let t=a[e];for(let e in t)u(t[e].object),delete t[e];delete a[e]}delete n[i],Object.keys(n).length===0&&delete r[t]}}}function T(){E(),o=!0,a!==i&&(a=i,l(a.object))}function E(){i.geometry=null,i.program=null,i.wireframe=!1}return{setup:s,reset:T,resetDefaultState:E,dispose:x,releaseStatesOfGeometry:S,releaseStatesOfObject:w,releaseStatesOfProgram:C,initAttributes:h,enableAttribute:g,disableUnusedAttributes:v}}function Xo(e,t,n){let r;function i(e){r=e}function a(t,i){e.drawArrays(r,t,i),n.update(i,r,1)}function o(t,i,a){a!==0&&(e.drawArraysInstanced(r,t,i,a),n.update(i,r,a))}function s(e,i,a){if(a===0)return;t.get(`WEBGL_multi_draw`).multiDrawArraysWEBGL(r,e,0,i,0,a);let o=0;for(let e=0;e<a;e++)o+=i[e];n.update(o,r,1)}this.setMode=i,this.render=a,this.renderInstances=o,this.renderMultiDraw=s}function Zo(e,t,n,r){let i;function a(){if(i!==void 0)return i;if(t.has(`EXT_texture_filter_anisotropic`)===!0){let n=t.get(`EXT_texture_filter_anisotropic`);i=e.getParameter(n.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else i=0;return i}function o(t){return t===1023||r.convert(t)===e.getParameter(e.IMPLEMENTATION_COLOR_READ_FORMAT)}function s(n){let i=n===1016&&(t.has(`EXT_color_buffer_half_float`)||t.has(`EXT_color_buffer_float`));return!(n!==1009&&n!==1015&&!i&&r.convert(n)!==e.getParameter(e.IMPLEMENTATION_COLOR_READ_TYPE))}function c(t){if(t===`highp`){if(e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.HIGH_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.HIGH_FLOAT).precision>0)return`highp`;t=`mediump`}return t===`mediump`&&e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.MEDIUM_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.MEDIUM_FLOAT).precision>0?`mediump`:`lowp`}let l=n.precision===void 0?`highp`:n.precision,u=c(l);u!==l&&(V(`WebGLRenderer:`,l,`not supported, using`,u,`instead.`),l=u);let d=n.reversedDepthBuffer===!0&&t.has(`EXT_clip_control`),f=n.logarithmicDepthBuffer===!0&&d===!1;n.reversedDepthBuffer===!0&&d===!1&&V(`WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer.`),n.logarithmicDepthBuffer===!0&&d===!0&&V(`WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.`);let p=e.getParameter(e.MAX_TEXTURE_IMAGE_UNITS),m=e.getParameter(e.MAX_VERTEX_TEXTURE_IMAGE_UNITS),h=e.getParameter(e.MAX_TEXTURE_SIZE),g=e.getParameter(e.MAX_CUBE_MAP_TEXTURE_SIZE),_=e.getParameter(e.MAX_VERTEX_ATTRIBS),v=e.getParameter(e.MAX_VERTEX_UNIFORM_VECTORS),y=e.getParameter(e.MAX_VARYING_VECTORS),b=e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),x=e.getParameter(e.MAX_SAMPLES),S=e.getParameter(e.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:a,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:s,precision:l,logarithmicDepthBuffer:f,reversedDepthBuffer:d,maxTextures:p,maxVertexTextures:m,maxTextureSize:h,maxCubemapSize:g,maxAttributes:_,maxVertexUniforms:v,maxVaryings:y,maxFragmentUniforms:b,maxSamples:x,samples:S}}function Qo(e){let t=this,n=null,r=0,i=!1,a=!1,o=new ci,s=new K,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(e,t){let n=e.length!==0||t||r!==0||i;return i=t,r=e.length,n},this.beginShadows=function(){a=!0,u(null)},this.endShadows=function(){a=!1},this.setGlobalState=function(e,t){n=u(e,t,0)},this.setState=function(t,o,s){let d=t.clippingPlanes,f=t.clipIntersection,p=t.clipShadows,m=e.get(t);if(!i||d===null||d.length===0||a&&!p)a?u(null):l();else{let e=a?0:r,t=e*4,i=m.clippingState||null;c.value=i,i=u(d,o,t,s);for(let e=0;e!==t;++e)i[e]=n[e];m.clippingState=i,this.numIntersection=f?this.numPlanes:0,this.numPlanes+=e}};function l(){c.value!==n&&(c.value=n,c.needsUpdate=r>0),t.numPlanes=r,t.numIntersection=0}function u(e,n,r,i){let a=e===null?0:e.length,l=null;if(a!==0){if(l=c.value,i!==!0||l===null){let t=r+a*4,i=n.matrixWorldInverse;s.getNormalMatrix(i),(l===null||l.length<t)&&(l=new Float32Array(t));for(let t=0,n=r;t!==a;++t,n+=4)o.copy(e[t]).applyMatrix4(i,s),o.normal.toArray(l,n),l[n+3]=o.constant}c.value=l,c.needsUpdate=!0}return t.numPlanes=a,t.numIntersection=0,l}}var $o=class extends Sn{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},r=[n,n,n,n,n,n];this.texture=new pa(r),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},r=new _a(5,5,5),i=new Pa({name:`CubemapFromEquirect`,uniforms:Ea(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:1,blending:0});i.uniforms.tEquirect.value=t;let a=new Oi(r,i),o=t.minFilter;return t.minFilter===1008&&(t.minFilter=P),new _o(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,r=!0){let i=e.getRenderTarget();for(let i=0;i<6;i++)e.setRenderTarget(this,i),e.clear(t,n,r);e.setRenderTarget(i)}},es=256,ts=3,ns=20,rs=256,is=16,as=3,os=new G,ss=new X,cs=class e{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new _o(1,10,null),this._boxMesh=new Oi(new _a(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,r=100,i={}){let{size:a=256,position:o=os}=i,s=this._renderer;this._setSize(a);let c=this._allocateTarget(),l=this._getSourceTarget(!0);t>0&&(l.texture.mipmapsAutoUpdate=!1);let u=s.autoClear,d=s.autoClearColor,f=s.autoClearDepth,p=s.autoClearStencil,m=e.background;s.autoClear=!0,s.autoClearColor=!0,s.autoClearDepth=!0,s.autoClearStencil=!0,m===null&&(e.background=s.getClearColor(ss));let h=new _o(n,r,l);return h.position.copy(o),h.update(s,e),s.autoClear=u,s.autoClearColor=d,s.autoClearDepth=f,s.autoClearStencil=p,e.background=m,t>0&&(l.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=hs(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=ms(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(es,Zt(e))}_fromTexture(e,t){e.mapping===301||e.mapping===302?this._setSize(e.image.length===0?es:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=ls(e,!1,!1),n=Math.log2(e)-ts;for(let r=0;r<=n;r++)t.texture.mipmaps.push({width:e>>r,height:e>>r});return t.texture.name=`PMREM`,t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=ls(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let r=this._boxMesh,i=this._cubeCamera;r.material=n,i.renderTarget=e,i.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),i.update(this._renderer,r),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===301||e.mapping===302?(this._cubemapMaterial===null&&(this._cubemapMaterial=hs()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=ms()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=ds(),this._integrationMaterial=fs());let n=this._cubeSize,r=t.texture.mipmaps.length-1,i=this._ggxMaterial.uniforms;i.envMap.value=this._sourceTarget.texture;let a=this._integrationMaterial.uniforms;a.envMap.value=this._sourceTarget.texture,a.sourceLod.value=Math.log2(n/is);for(let o=0;o<=r;o++){let s=e.lodToRoughness(o,r);if(o>r-as)a.roughness.value=s,this._renderCube(t,o,this._integrationMaterial);else{let e=s>0?Math.log2(n)+.5*Math.log2(6/(rs*s**4))+.5:0;i.roughness.value=s,i.lodBias.value=e,this._renderCube(t,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=ps());let n=this._blurMaterial,r=n.uniforms,i=this._sourceTarget;r.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,r.envMap.value=i.texture,this._renderCube(e,0,n),r.envMap.value=e.texture,this._renderCube(i,0,n)}};function ls(e,t,n){return new $o(e,{minFilter:re,generateMipmaps:t,type:le,colorSpace:ft,depthBuffer:n})}function us(e,t,n){return new Pa({name:e,uniforms:t,vertexShader:Z.cube_vert,fragmentShader:n,side:1,blending:0,depthTest:!1,depthWrite:!1})}function ds(){return us(`PMREMGGXConvolution`,{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${rs}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function fs(){return us(`PMREMGGXIntegration`,{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:is}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function ps(){return us(`PMREMSphericalGaussianBlur`,{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${ns}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function ms(){return us(`PMREMEquirectangularToCubemap`,{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function hs(){return us(`PMREMCubemapToCubemap`,{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function gs(e){let t=new WeakMap,n=new WeakMap,r=null;function i(e,t=!1){return e==null?null:t?o(e):a(e)}function a(n){if(n&&n.isTexture){let r=n.mapping;if(r===303||r===304){if(t.has(n)){let e=t.get(n).texture;return s(e,n.mapping)}{let r=n.image;if(r&&r.height>0){let i=new $o(r.height);return i.fromEquirectangularTexture(e,n),t.set(n,i),n.addEventListener(`dispose`,l),s(i.texture,n.mapping)}return null}}}return n}function o(t){if(t&&t.isTexture&&t.isPMREMTexture!==!0){let i=t.mapping,a=i===303||i===304,o=i===301||i===302;if(a||o){let i=n.get(t),s=i===void 0?0:i.texture.pmremVersion;if(t.isRenderTargetTexture&&t.pmremVersion!==s)return r===null&&(r=new cs(e)),i=a?r.fromEquirectangular(t,i):r.fromCubemap(t,i),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),i.texture;if(i!==void 0)return i.texture;{let s=t.image;return a&&s&&s.height>0||o&&s&&c(s)?(r===null&&(r=new cs(e)),i=a?r.fromEquirectangular(t):r.fromCubemap(t),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),t.addEventListener(`dispose`,u),i.texture):null}}}return t}function s(e,t){return t===303?e.mapping=301:t===304&&(e.mapping=302),e}function c(e){let t=0;for(let n=0;n<6;n++)e[n]!==void 0&&t++;return t===6}function l(e){let n=e.target;n.removeEventListener(`dispose`,l);let r=t.get(n);r!==void 0&&(t.delete(n),r.dispose())}function u(e){let t=e.target;t.removeEventListener(`dispose`,u);let r=n.get(t);r!==void 0&&(n.delete(t),r.dispose())}function d(){t=new WeakMap,n=new WeakMap,r!==null&&(r.dispose(),r=null)}return{get:i,dispose:d}}function _s(e){let t={};function n(n){if(t[n]!==void 0)return t[n];let r=e.getExtension(n);return t[n]=r,r}return{has:function(e){return n(e)!==null},init:function(){n(`EXT_color_buffer_float`),n(`WEBGL_clip_cull_distance`),n(`OES_texture_float_linear`),n(`EXT_color_buffer_half_float`),n(`WEBGL_multisampled_render_to_texture`),n(`WEBGL_render_shared_exponent`)},get:function(e){let t=n(e);return t===null&&Et(`WebGLRenderer: `+e+` extension not supported.`),t}}}function vs(e,t,n,r){let i={},a=new WeakMap,o=new FinalizationRegistry(e=>delete i[e]);function s(e){c(e.target)}function c(e){e.index!==null&&t.remove(e.index);for(let n in e.attributes)t.remove(e.attributes[n]);e.removeEventListener(`dispose`,s),delete i[e.id],o.unregister(e);let c=a.get(e);c&&(t.remove(c),a.delete(e)),r.releaseStatesOfGeometry(e),e.isInstancedBufferGeometry===!0&&delete e._maxInstanceCount,n.memory.geometries--}function l(e,t){return i[t.id]===void 0&&(t.addEventListener(`dispose`,s),i[t.id]=new WeakRef(t),o.register(t,t.id,t),n.memory.geometries++),t}function u(n){let r=n.attributes;for(let n in r)t.update(r[n],e.ARRAY_BUFFER)}function d(e){let n=e.index,r=e.attributes.position,i=0;if(r===void 0)return;let o=n===null?r.array.length/3-1:n.array.length,s=new(r.count>=65535?Vr:Br)(Math.ceil(o/3)*6,1),c=s.array;if(n!==null){let e=n.array;i=n.version;for(let t=0,n=0;t<o;t+=3){let r=e[t+0],i=e[t+1],a=e[t+2];c[n++]=r,c[n++]=i,c[n++]=i,c[n++]=a,c[n++]=a,c[n++]=r}}else{i=r.version;for(let e=0,t=0;e<o;e+=3){let n=e+0,r=e+1,i=e+2;c[t++]=n,c[t++]=r,c[t++]=r,c[t++]=i,c[t++]=i,c[t++]=n}}s.version=i;let l=a.get(e);l&&t.remove(l),a.set(e,s)}function f(e){let t=a.get(e);if(t){let n=e.index;n!==null&&t.version<n.version&&d(e)}else d(e);return a.get(e)}function p(){for(let e in i){let t=i[e].deref();t!==void 0&&c(t)}}return{get:l,update:u,getWireframeAttribute:f,dispose:p}}function ys(e,t,n){let r;function i(e){r=e}let a,o;function s(e){a=e.type,o=e.bytesPerElement}function c(t,i){e.drawElements(r,i,a,t*o),n.update(i,r,1)}function l(t,i,s){s!==0&&(e.drawElementsInstanced(r,i,a,t*o,s),n.update(i,r,s))}function u(e,i,o){if(o===0)return;t.get(`WEBGL_multi_draw`).multiDrawElementsWEBGL(r,i,0,a,e,0,o);let s=0;for(let e=0;e<o;e++)s+=i[e];n.update(s,r,1)}this.setMode=i,this.setIndex=s,this.render=c,this.renderInstances=l,this.renderMultiDraw=u}function bs(e){let t={geometries:0,textures:0},n={frame:0,calls:0,triangles:0,points:0,lines:0};function r(t,r,i){switch(n.calls++,r){case e.TRIANGLES:n.triangles+=t/3*i;break;case e.LINES:n.lines+=t/2*i;break;case e.LINE_STRIP:n.lines+=i*(t-1);break;case e.LINE_LOOP:n.lines+=i*t;break;case e.POINTS:n.points+=i*t;break;default:H(`WebGLInfo: Unknown draw mode:`,r)}}function i(){n.calls=0,n.triangles=0,n.points=0,n.lines=0}return{memory:t,render:n,programs:null,autoReset:!0,reset:i,update:r}}function xs(e,t,n){let r=new WeakMap,i=new J;function a(a,o,s){let c=a.morphTargetInfluences,l=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=l===void 0?0:l.length,d=r.get(o);if(d===void 0||d.count!==u){d!==void 0&&d.texture.dispose();let e=o.morphAttributes.position!==void 0,n=o.morphAttributes.normal!==void 0,a=o.morphAttributes.color!==void 0,s=o.morphAttributes.position||[],c=o.morphAttributes.normal||[],l=o.morphAttributes.color||[],f=0;e===!0&&(f=1),n===!0&&(f=2),a===!0&&(f=3);let p=o.attributes.position.count*f,m=1;p>t.maxTextureSize&&(m=Math.ceil(p/t.maxTextureSize),p=t.maxTextureSize);let h=new Float32Array(p*m*4*u),g=new Cn(h,p,m,u);g.type=I,g.needsUpdate=!0;let _=f*4;for(let t=0;t<u;t++){let r=s[t],o=c[t],u=l[t],d=p*m*4*t;for(let t=0;t<r.count;t++){let s=t*_;e===!0&&(i.fromBufferAttribute(r,t),h[d+s+0]=i.x,h[d+s+1]=i.y,h[d+s+2]=i.z,h[d+s+3]=0),n===!0&&(i.fromBufferAttribute(o,t),h[d+s+4]=i.x,h[d+s+5]=i.y,h[d+s+6]=i.z,h[d+s+7]=0),a===!0&&(i.fromBufferAttribute(u,t),h[d+s+8]=i.x,h[d+s+9]=i.y,h[d+s+10]=i.z,h[d+s+11]=u.itemSize===4?i.w:1)}}d={count:u,texture:g,size:new W(p,m)},r.set(o,d);function v(){g.dispose(),r.delete(o),o.removeEventListener(`dispose`,v)}o.addEventListener(`dispose`,v)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)s.getUniforms().setValue(e,`morphTexture`,a.morphTexture,n);else{let t=0;for(let e=0;e<c.length;e++)t+=c[e];let n=o.morphTargetsRelative?1:1-t;s.getUniforms().setValue(e,`morphTargetBaseInfluence`,n),s.getUniforms().setValue(e,`morphTargetInfluences`,c)}s.getUniforms().setValue(e,`morphTargetsTexture`,d.texture,n),s.getUniforms().setValue(e,`morphTargetsTextureSize`,d.size)}return{update:a}}function Ss(e,t,n,r,i){let a=new WeakMap;function o(r){let o=i.render.frame,s=r.geometry,l=t.get(r,s);if(a.get(l)!==o&&(t.update(l),a.set(l,o)),r.isInstancedMesh&&(r.hasEventListener(`dispose`,c)===!1&&r.addEventListener(`dispose`,c),a.get(r)!==o&&(n.update(r.instanceMatrix,e.ARRAY_BUFFER),r.instanceColor!==null&&n.update(r.instanceColor,e.ARRAY_BUFFER),a.set(r,o))),r.isSkinnedMesh){let e=r.skeleton;a.get(e)!==o&&(e.update(),a.set(e,o))}return l}function s(){a=new WeakMap}function c(e){let t=e.target;t.removeEventListener(`dispose`,c),r.releaseStatesOfObject(t),n.remove(t.instanceMatrix),t.instanceColor!==null&&n.remove(t.instanceColor)}return{update:o,dispose:s}}var Cs={1:`LINEAR_TONE_MAPPING`,2:`REINHARD_TONE_MAPPING`,3:`CINEON_TONE_MAPPING`,4:`ACES_FILMIC_TONE_MAPPING`,6:`AGX_TONE_MAPPING`,7:`NEUTRAL_TONE_MAPPING`,5:`CUSTOM_TONE_MAPPING`};function ws(e,t,n,r,i,a){let o=new Sn(t,n,{type:e,depthBuffer:i,stencilBuffer:a,samples:r?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),s=null,c=null,l=null,u=new ei;u.setAttribute(`position`,new Hr([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute(`uv`,new Hr([0,2,0,0,2,0],2));let d=new Fa({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new Oi(u,d),p=new po(-1,1,1,-1,0,1),m=null,h=null,g=!1,_,v=null,y=[],b=!1;this.setSize=function(e,t){o.setSize(e,t),s!==null&&s.setSize(e,t),c!==null&&c.setSize(e,t);for(let n=0;n<y.length;n++){let r=y[n];r.setSize&&r.setSize(e,t)}},this.setEffects=function(e){y=e,b=y.length>0&&y[0].isRenderPass===!0;let t=o.width,n=o.height;y.length>0&&s===null&&(s=new Sn(t,n,{type:le,depthBuffer:!1,stencilBuffer:!1}),c=new Sn(t,n,{type:le,depthBuffer:!1,stencilBuffer:!1}));let r=i===!0&&y.some(e=>e.needsDepthTexture===!0);r!==(o.depthTexture!==null)&&(r===!0&&l===null&&(l=new ma(t,n),a===!0&&(l.format=ye,l.type=fe)),o.dispose(),o.depthTexture=r?l:null,o.resolveDepthBuffer=r,o.storeMultisampledDepthBuffer=r);for(let e=0;e<y.length;e++){let i=y[e];i.setSize&&i.setSize(t,n),r&&i.needsDepthTexture===!0&&i.setDepthTexture&&i.setDepthTexture(l)}},this.begin=function(e,t){if(g||e.toneMapping===0&&y.length===0)return!1;if(v=t,t!==null){let e=t.width,n=t.height;(o.width!==e||o.height!==n)&&this.setSize(e,n)}return b===!1&&e.setRenderTarget(o),_=e.toneMapping,e.toneMapping=0,!0},this.hasRenderPass=function(){return b},this.end=function(e,t){e.toneMapping=_,g=!0;let n=o,r=s;for(let i=0;i<y.length;i++){let a=y[i];a.enabled!==!1&&(a.render(e,r,n,t),a.needsSwap!==!1&&(n=r,r=r===s?c:s))}if(m!==e.outputColorSpace||h!==e.toneMapping){m=e.outputColorSpace,h=e.toneMapping,d.defines={},q.getTransfer(m)===`srgb`&&(d.defines.SRGB_TRANSFER=``);let t=Cs[h];t&&(d.defines[t]=``),d.needsUpdate=!0}d.uniforms.tDiffuse.value=n.texture,e.setRenderTarget(v),e.render(f,p),v=null,g=!1},this.isCompositing=function(){return g},this.dispose=function(){o.dispose(),s!==null&&s.dispose(),c!==null&&c.dispose(),u.dispose(),d.dispose()}}var Ts=new bn,Es=new ma(1,1),Ds=new ha(1),Os=new Cn,ks=new wn,As=new pa,js=[],Ms=[],Ns=new Float32Array(16),Ps=new Float32Array(9),Fs=new Float32Array(4);function Is(e,t,n){let r=e[0];if(r<=0||r>0)return e;let i=t*n,a=js[i];if(a===void 0&&(a=new Float32Array(i),js[i]=a),t!==0){r.toArray(a,0);for(let r=1,i=0;r!==t;++r)i+=n,e[r].toArray(a,i)}return a}function Ls(e,t){if(e.length!==t.length)return!1;for(let n=0,r=e.length;n<r;n++)if(e[n]!==t[n])return!1;return!0}function Rs(e,t){for(let n=0,r=t.length;n<r;n++)e[n]=t[n]}function zs(e,t){let n=Ms[t];n===void 0&&(n=new Int32Array(t),Ms[t]=n);for(let r=0;r!==t;++r)n[r]=e.allocateTextureUnit();return n}function Bs(e,t){let n=this.cache;n[0]!==t&&(e.uniform1f(this.addr,t),n[0]=t)}function Vs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2f(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Ls(n,t))return;e.uniform2fv(this.addr,t),Rs(n,t)}}function Hs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3f(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else if(t.r!==void 0)(n[0]!==t.r||n[1]!==t.g||n[2]!==t.b)&&(e.uniform3f(this.addr,t.r,t.g,t.b),n[0]=t.r,n[1]=t.g,n[2]=t.b);else{if(Ls(n,t))return;e.uniform3fv(this.addr,t),Rs(n,t)}}function Us(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4f(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Ls(n,t))return;e.uniform4fv(this.addr,t),Rs(n,t)}}function Ws(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Ls(n,t))return;e.uniformMatrix2fv(this.addr,!1,t),Rs(n,t)}else{if(Ls(n,r))return;Fs.set(r),e.uniformMatrix2fv(this.addr,!1,Fs),Rs(n,r)}}function Gs(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Ls(n,t))return;e.uniformMatrix3fv(this.addr,!1,t),Rs(n,t)}else{if(Ls(n,r))return;Ps.set(r),e.uniformMatrix3fv(this.addr,!1,Ps),Rs(n,r)}}function Ks(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(Ls(n,t))return;e.uniformMatrix4fv(this.addr,!1,t),Rs(n,t)}else{if(Ls(n,r))return;Ns.set(r),e.uniformMatrix4fv(this.addr,!1,Ns),Rs(n,r)}}function qs(e,t){let n=this.cache;n[0]!==t&&(e.uniform1i(this.addr,t),n[0]=t)}function Js(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2i(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Ls(n,t))return;e.uniform2iv(this.addr,t),Rs(n,t)}}function Ys(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3i(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(Ls(n,t))return;e.uniform3iv(this.addr,t),Rs(n,t)}}function Xs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4i(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Ls(n,t))return;e.uniform4iv(this.addr,t),Rs(n,t)}}function Zs(e,t){let n=this.cache;n[0]!==t&&(e.uniform1ui(this.addr,t),n[0]=t)}function Qs(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2ui(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(Ls(n,t))return;e.uniform2uiv(this.addr,t),Rs(n,t)}}function $s(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3ui(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(Ls(n,t))return;e.uniform3uiv(this.addr,t),Rs(n,t)}}function ec(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4ui(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(Ls(n,t))return;e.uniform4uiv(this.addr,t),Rs(n,t)}}function tc(e){return e.version===0&&(e.compareFunction=519,e.needsUpdate=!0),e}function nc(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_2D_SHADOW?tc(Es):Ts,n.setTexture2D(t||a,i)}function rc(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture3D(t||ks,i)}function ic(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_CUBE_SHADOW?tc(Ds):As,n.setTextureCube(t||a,i)}function ac(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture2DArray(t||Os,i)}function oc(e){switch(e){case 5126:return Bs;case 35664:return Vs;case 35665:return Hs;case 35666:return Us;case 35674:return Ws;case 35675:return Gs;case 35676:return Ks;case 5124:case 35670:return qs;case 35667:case 35671:return Js;case 35668:case 35672:return Ys;case 35669:case 35673:return Xs;case 5125:return Zs;case 36294:return Qs;case 36295:return $s;case 36296:return ec;case 35678:case 36198:case 36298:case 36306:case 35682:return nc;case 35679:case 36299:case 36307:return rc;case 35680:case 36300:case 36308:case 36293:return ic;case 36289:case 36303:case 36311:case 36292:return ac}}function sc(e,t){e.uniform1fv(this.addr,t)}function cc(e,t){let n=Is(t,this.size,2);e.uniform2fv(this.addr,n)}function lc(e,t){let n=Is(t,this.size,3);e.uniform3fv(this.addr,n)}function uc(e,t){let n=Is(t,this.size,4);e.uniform4fv(this.addr,n)}function dc(e,t){let n=Is(t,this.size,4);e.uniformMatrix2fv(this.addr,!1,n)}function fc(e,t){let n=Is(t,this.size,9);e.uniformMatrix3fv(this.addr,!1,n)}function pc(e,t){let n=Is(t,this.size,16);e.uniformMatrix4fv(this.addr,!1,n)}function mc(e,t){e.uniform1iv(this.addr,t)}function hc(e,t){e.uniform2iv(this.addr,t)}function gc(e,t){e.uniform3iv(this.addr,t)}function _c(e,t){e.uniform4iv(this.addr,t)}function vc(e,t){e.uniform1uiv(this.addr,t)}function yc(e,t){e.uniform2uiv(this.addr,t)}function bc(e,t){e.uniform3uiv(this.addr,t)}function xc(e,t){e.uniform4uiv(this.addr,t)}function Sc(e,t,n){let r=this.cache,i=t.length,a=zs(n,i);Ls(r,a)||(e.uniform1iv(this.addr,a),Rs(r,a));let o;o=this.type===e.SAMPLER_2D_SHADOW?tc(Es):Ts;for(let e=0;e!==i;++e)n.setTexture2D(t[e]||o,a[e])}function Cc(e,t,n){let r=this.cache,i=t.length,a=zs(n,i);Ls(r,a)||(e.uniform1iv(this.addr,a),Rs(r,a));for(let e=0;e!==i;++e)n.setTexture3D(t[e]||ks,a[e])}function wc(e,t,n){let r=this.cache,i=t.length,a=zs(n,i);Ls(r,a)||(e.uniform1iv(this.addr,a),Rs(r,a));let o;o=this.type===e.SAMPLER_CUBE_SHADOW?tc(Ds):As;for(let e=0;e!==i;++e)n.setTextureCube(t[e]||o,a[e])}function Tc(e,t,n){let r=this.cache,i=t.length,a=zs(n,i);Ls(r,a)||(e.uniform1iv(this.addr,a),Rs(r,a));for(let e=0;e!==i;++e)n.setTexture2DArray(t[e]||Os,a[e])}function Ec(e){switch(e){case 5126:return sc;case 35664:return cc;case 35665:return lc;case 35666:return uc;case 35674:return dc;case 35675:return fc;case 35676:return pc;case 5124:case 35670:return mc;case 35667:case 35671:return hc;case 35668:case 35672:return gc;case 35669:case 35673:return _c;case 5125:return vc;case 36294:return yc;case 36295:return bc;case 36296:return xc;case 35678:case 36198:case 36298:case 36306:case 35682:return Sc;case 35679:case 36299:case 36307:return Cc;case 35680:case 36300:case 36308:case 36293:return wc;case 36289:case 36303:case 36311:case 36292:return Tc}}var Dc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=oc(t.type)}},Oc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Ec(t.type)}},kc=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let r=this.seq;for(let i=0,a=r.length;i!==a;++i){let a=r[i];a.setValue(e,t[a.id],n)}}},Ac=/(\w+)(\])?(\[|\.)?/g;function jc(e,t){e.seq.push(t),e.map[t.id]=t}function Mc(e,t,n){let r=e.name,i=r.length;for(Ac.lastIndex=0;;){let a=Ac.exec(r),o=Ac.lastIndex,s=a[1],c=a[2]===`]`,l=a[3];if(c&&(s|=0),l===void 0||l===`[`&&o+2===i){jc(n,l===void 0?new Dc(s,e,t):new Oc(s,e,t));break}{let e=n.map[s];e===void 0&&(e=new kc(s),jc(n,e)),n=e}}}var Nc=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let r=0;r<n;++r){let n=e.getActiveUniform(t,r);Mc(n,e.getUniformLocation(t,n.name),this)}let r=[],i=[];for(let t of this.seq)t.type===e.SAMPLER_2D_SHADOW||t.type===e.SAMPLER_CUBE_SHADOW||t.type===e.SAMPLER_2D_ARRAY_SHADOW?r.push(t):i.push(t);r.length>0&&(this.seq=r.concat(i))}setValue(e,t,n,r){let i=this.map[t];i!==void 0&&i.setValue(e,n,r)}setOptional(e,t,n){let r=t[n];r!==void 0&&this.setValue(e,n,r)}static upload(e,t,n,r){for(let i=0,a=t.length;i!==a;++i){let a=t[i],o=n[a.id];o.needsUpdate!==!1&&a.setValue(e,o.value,r)}}static seqWithValue(e,t){let n=[];for(let r=0,i=e.length;r!==i;++r){let i=e[r];i.id in t&&n.push(i)}return n}};function Pc(e,t,n){let r=e.createShader(t);return e.shaderSource(r,n),e.compileShader(r),r}var Fc=37297,Ic=0;function Lc(e,t){let n=e.split(`
`),r=[],i=Math.max(t-6,0),a=Math.min(t+6,n.length);for(let e=i;e<a;e++){let i=e+1;r.push(`${i===t?`>`:` `} ${i}: ${n[e]}`)}return r.join(`
`)}var Rc=new K;function zc(e){q._getMatrix(Rc,q.workingColorSpace,e);let t=`mat3( ${Rc.elements.map(e=>e.toFixed(4))} )`;switch(q.getTransfer(e)){case pt:return[t,`LinearTransferOETF`];case mt:return[t,`sRGBTransferOETF`];default:return V(`WebGLProgram: Unsupported color space: `,e),[t,`LinearTransferOETF`]}}function Bc(e,t,n){let r=e.getShaderParameter(t,e.COMPILE_STATUS),i=(e.getShaderInfoLog(t)||``).trim();if(r&&i===``)return``;let a=/ERROR: 0:(\d+)/.exec(i);if(a){let r=parseInt(a[1]);return n.toUpperCase()+`

`+i+`

`+Lc(e.getShaderSource(t),r)}return i}function Vc(e,t){let n=zc(t);return[`vec4 ${e}( vec4 value ) {`,`	return ${n[1]}( vec4( ${n[0]} * value.rgb, value.a ) );`,`}`].join(`
`)}var Hc={1:`Linear`,2:`Reinhard`,3:`Cineon`,4:`ACESFilmic`,6:`AgX`,7:`Neutral`,5:`Custom`};function Uc(e,t){let n=Hc[t];return n===void 0?(V(`WebGLProgram: Unsupported toneMapping:`,t),`vec3 `+e+`( vec3 color ) { return LinearToneMapping( color ); }`):`vec3 `+e+`( vec3 color ) { return `+n+`ToneMapping( color ); }`}var Wc=new G;function Gc(){return q.getLuminanceCoefficients(Wc),[`float luminance( const in vec3 rgb ) {`,`	const vec3 weights = vec3( ${Wc.x.toFixed(4)}, ${Wc.y.toFixed(4)}, ${Wc.z.toFixed(4)} );`,`	return dot( weights, rgb );`,`}`].join(`
`)}function Kc(e){return[e.extensionClipCullDistance?`#extension GL_ANGLE_clip_cull_distance : require`:``,e.extensionMultiDraw?`#extension GL_ANGLE_multi_draw : require`:``].filter(Yc).join(`
`)}function qc(e){let t=[];for(let n in e){let r=e[n];r!==!1&&t.push(`#define `+n+` `+r)}return t.join(`
`)}function Jc(e,t){let n={},r=e.getProgramParameter(t,e.ACTIVE_ATTRIBUTES);for(let i=0;i<r;i++){let r=e.getActiveAttrib(t,i),a=r.name,o=1;r.type===e.FLOAT_MAT2&&(o=2),r.type===e.FLOAT_MAT3&&(o=3),r.type===e.FLOAT_MAT4&&(o=4),n[a]={type:r.type,location:e.getAttribLocation(t,a),locationSize:o}}return n}function Yc(e){return e!==``}function Xc(e,t){let n=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return e.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,n).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function Zc(e,t){return e.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var Qc=/^[ \t]*#include +<([\w\d./]+)>/gm;function $c(e){return e.replace(Qc,el)}function el(e,t){let n=Z[t];if(n===void 0)throw Error(`THREE.WebGLProgram: Can not resolve #include <`+t+`>`);return $c(n)}var tl=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function nl(e){return e.replace(tl,rl)}function rl(e,t,n,r){let i=``;for(let e=parseInt(t);e<parseInt(n);e++)i+=r.replace(/\[\s*i\s*\]/g,`[ `+e+` ]`).replace(/UNROLLED_LOOP_INDEX/g,e);return i}function il(e){let t=`precision ${e.precision} float;
	precision ${e.precision} int;
	precision ${e.precision} sampler2D;
	precision ${e.precision} samplerCube;
	precision ${e.precision} sampler3D;
	precision ${e.precision} sampler2DArray;
	precision ${e.precision} sampler2DShadow;
	precision ${e.precision} samplerCubeShadow;
	precision ${e.precision} sampler2DArrayShadow;
	precision ${e.precision} isampler2D;
	precision ${e.precision} isampler3D;
	precision ${e.precision} isamplerCube;
	precision ${e.precision} isampler2DArray;
	precision ${e.precision} usampler2D;
	precision ${e.precision} usampler3D;
	precision ${e.precision} usamplerCube;
	precision ${e.precision} usampler2DArray;
	`;return e.precision===`highp`?t+=`
#define HIGH_PRECISION`:e.precision===`mediump`?t+=`
#define MEDIUM_PRECISION`:e.precision===`lowp`&&(t+=`
#define LOW_PRECISION`),t}var al={1:`SHADOWMAP_TYPE_PCF`,3:`SHADOWMAP_TYPE_VSM`};function ol(e){return al[e.shadowMapType]||`SHADOWMAP_TYPE_BASIC`}var sl={302:`ENVMAP_MODE_REFRACTION`};function cl(e){return e.envMap===!1?`ENVMAP_MODE_REFLECTION`:sl[e.envMapMode]||`ENVMAP_MODE_REFLECTION`}var ll={0:`ENVMAP_BLENDING_MULTIPLY`,1:`ENVMAP_BLENDING_MIX`,2:`ENVMAP_BLENDING_ADD`};function ul(e){return e.envMap===!1?`ENVMAP_BLENDING_NONE`:ll[e.combine]||`ENVMAP_BLENDING_NONE`}function dl(e,t,n,r){let i=e.getContext(),a=n.defines,o=n.vertexShader,s=n.fragmentShader,c=ol(n),l=n.envMapPMREM===!0?`ENVMAP_TYPE_PMREM`:`ENVMAP_TYPE_CUBE`,u=cl(n),d=ul(n),f=Kc(n),p=qc(a),m=i.createProgram(),h,g,_=n.glslVersion?`#version `+n.glslVersion+`
`:``;n.isRawShaderMaterial?(h=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(Yc).join(`
`),h.length>0&&(h+=`
`),g=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(Yc).join(`
`),g.length>0&&(g+=`
`)):(h=[il(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.extensionClipCullDistance?`#define USE_CLIP_DISTANCE`:``,n.batching?`#define USE_BATCHING`:``,n.batchingColor?`#define USE_BATCHING_COLOR`:``,n.instancing?`#define USE_INSTANCING`:``,n.instancingColor?`#define USE_INSTANCING_COLOR`:``,n.instancingMorph?`#define USE_INSTANCING_MORPH`:``,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.map?`#define USE_MAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+u:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.displacementMap?`#define USE_DISPLACEMENTMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.mapUv?`#define MAP_UV `+n.mapUv:``,n.alphaMapUv?`#define ALPHAMAP_UV `+n.alphaMapUv:``,n.lightMapUv?`#define LIGHTMAP_UV `+n.lightMapUv:``,n.aoMapUv?`#define AOMAP_UV `+n.aoMapUv:``,n.emissiveMapUv?`#define EMISSIVEMAP_UV `+n.emissiveMapUv:``,n.bumpMapUv?`#define BUMPMAP_UV `+n.bumpMapUv:``,n.normalMapUv?`#define NORMALMAP_UV `+n.normalMapUv:``,n.displacementMapUv?`#define DISPLACEMENTMAP_UV `+n.displacementMapUv:``,n.metalnessMapUv?`#define METALNESSMAP_UV `+n.metalnessMapUv:``,n.roughnessMapUv?`#define ROUGHNESSMAP_UV `+n.roughnessMapUv:``,n.anisotropyMapUv?`#define ANISOTROPYMAP_UV `+n.anisotropyMapUv:``,n.clearcoatMapUv?`#define CLEARCOATMAP_UV `+n.clearcoatMapUv:``,n.clearcoatNormalMapUv?`#define CLEARCOAT_NORMALMAP_UV `+n.clearcoatNormalMapUv:``,n.clearcoatRoughnessMapUv?`#define CLEARCOAT_ROUGHNESSMAP_UV `+n.clearcoatRoughnessMapUv:``,n.diffuseRoughnessMapUv?`#define DIFFUSE_ROUGHNESSMAP_UV `+n.diffuseRoughnessMapUv:``,n.iridescenceMapUv?`#define IRIDESCENCEMAP_UV `+n.iridescenceMapUv:``,n.iridescenceThicknessMapUv?`#define IRIDESCENCE_THICKNESSMAP_UV `+n.iridescenceThicknessMapUv:``,n.sheenColorMapUv?`#define SHEEN_COLORMAP_UV `+n.sheenColorMapUv:``,n.sheenRoughnessMapUv?`#define SHEEN_ROUGHNESSMAP_UV `+n.sheenRoughnessMapUv:``,n.specularMapUv?`#define SPECULARMAP_UV `+n.specularMapUv:``,n.specularColorMapUv?`#define SPECULAR_COLORMAP_UV `+n.specularColorMapUv:``,n.specularIntensityMapUv?`#define SPECULAR_INTENSITYMAP_UV `+n.specularIntensityMapUv:``,n.transmissionMapUv?`#define TRANSMISSIONMAP_UV `+n.transmissionMapUv:``,n.thicknessMapUv?`#define THICKNESSMAP_UV `+n.thicknessMapUv:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexNormals?`#define HAS_NORMAL`:``,n.vertexColors?`#define USE_COLOR`:``,n.vertexAlphas?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.flatShading?`#define FLAT_SHADED`:``,n.skinning?`#define USE_SKINNING`:``,n.morphTargets?`#define USE_MORPHTARGETS`:``,n.morphNormals&&n.flatShading===!1?`#define USE_MORPHNORMALS`:``,n.morphColors?`#define USE_MORPHCOLORS`:``,n.morphTargetsCount>0?`#define MORPHTARGETS_TEXTURE_STRIDE `+n.morphTextureStride:``,n.morphTargetsCount>0?`#define MORPHTARGETS_COUNT `+n.morphTargetsCount:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.sizeAttenuation?`#define USE_SIZEATTENUATION`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 modelMatrix;`,`uniform mat4 modelViewMatrix;`,`uniform mat4 projectionMatrix;`,`uniform mat4 viewMatrix;`,`uniform mat3 normalMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,`#ifdef USE_INSTANCING`,`	attribute mat4 instanceMatrix;`,`#endif`,`#ifdef USE_INSTANCING_COLOR`,`	attribute vec3 instanceColor;`,`#endif`,`#ifdef USE_INSTANCING_MORPH`,`	uniform sampler2D morphTexture;`,`#endif`,`attribute vec3 position;`,`attribute vec3 normal;`,`attribute vec2 uv;`,`#ifdef USE_UV1`,`	attribute vec2 uv1;`,`#endif`,`#ifdef USE_UV2`,`	attribute vec2 uv2;`,`#endif`,`#ifdef USE_UV3`,`	attribute vec2 uv3;`,`#endif`,`#ifdef USE_TANGENT`,`	attribute vec4 tangent;`,`#endif`,`#if defined( USE_COLOR_ALPHA )`,`	attribute vec4 color;`,`#elif defined( USE_COLOR )`,`	attribute vec3 color;`,`#endif`,`#ifdef USE_SKINNING`,`	attribute vec4 skinIndex;`,`	attribute vec4 skinWeight;`,`#endif`,`
`].filter(Yc).join(`
`),g=[il(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.alphaToCoverage?`#define ALPHA_TO_COVERAGE`:``,n.map?`#define USE_MAP`:``,n.matcap?`#define USE_MATCAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+l:``,n.envMap?`#define `+u:``,n.envMap?`#define `+d:``,n.envMapPMREM?`#define ENVMAP_MAX_LOD `+n.envMapMaxLod+`.0`:``,n.envMapPMREM?`#define ENVMAP_SIZE `+n.envMapSize+`.0`:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.packedNormalMap?`#define USE_PACKED_NORMALMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoat?`#define USE_CLEARCOAT`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughness?`#define USE_DIFFUSE_ROUGHNESS`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.dispersion?`#define USE_DISPERSION`:``,n.retroreflection?`#define USE_RETROREFLECTION`:``,n.iridescence?`#define USE_IRIDESCENCE`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaTest?`#define USE_ALPHATEST`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.sheen?`#define USE_SHEEN`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexColors||n.instancingColor?`#define USE_COLOR`:``,n.vertexAlphas||n.batchingColor?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.gradientMap?`#define USE_GRADIENTMAP`:``,n.flatShading?`#define FLAT_SHADED`:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.premultipliedAlpha?`#define PREMULTIPLIED_ALPHA`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.decodeVideoTexture?`#define DECODE_VIDEO_TEXTURE`:``,n.decodeVideoTextureEmissive?`#define DECODE_VIDEO_TEXTURE_EMISSIVE`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 viewMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,n.toneMapping===0?``:`#define TONE_MAPPING`,n.toneMapping===0?``:Z.tonemapping_pars_fragment,n.toneMapping===0?``:Uc(`toneMapping`,n.toneMapping),n.dithering?`#define DITHERING`:``,n.opaque?`#define OPAQUE`:``,Z.colorspace_pars_fragment,Vc(`linearToOutputTexel`,n.outputColorSpace),Gc(),n.useDepthPacking?`#define DEPTH_PACKING `+n.depthPacking:``,`
`].filter(Yc).join(`
`)),o=$c(o),o=Xc(o,n),o=Zc(o,n),s=$c(s),s=Xc(s,n),s=Zc(s,n),o=nl(o),s=nl(s),n.isRawShaderMaterial!==!0&&(_=`#version 300 es
`,h=[f,`#define attribute in`,`#define varying out`,`#define texture2D texture`].join(`
`)+`
`+h,g=[`#define varying in`,n.glslVersion===`300 es`?``:`layout(location = 0) out highp vec4 pc_fragColor;`,n.glslVersion===`300 es`?``:`#define gl_FragColor pc_fragColor`,`#define gl_FragDepthEXT gl_FragDepth`,`#define texture2D texture`,`#define textureCube texture`,`#define texture2DProj textureProj`,`#define texture2DLodEXT textureLod`,`#define texture2DProjLodEXT textureProjLod`,`#define textureCubeLodEXT textureLod`,`#define texture2DGradEXT textureGrad`,`#define texture2DProjGradEXT textureProjGrad`,`#define textureCubeGradEXT textureGrad`].join(`
`)+`
`+g);let v=_+h+o,y=_+g+s,b=Pc(i,i.VERTEX_SHADER,v),x=Pc(i,i.FRAGMENT_SHADER,y);i.attachShader(m,b),i.attachShader(m,x),n.index0AttributeName===void 0?n.hasPositionAttribute===!0&&i.bindAttribLocation(m,0,`position`):i.bindAttribLocation(m,0,n.index0AttributeName),i.linkProgram(m);function S(t){if(e.debug.checkShaderErrors){let n=i.getProgramInfoLog(m)||``,r=i.getShaderInfoLog(b)||``,a=i.getShaderInfoLog(x)||``,o=n.trim(),s=r.trim(),c=a.trim(),l=!0,u=!0;if(i.getProgramParameter(m,i.LINK_STATUS)===!1){if(l=!1,typeof e.debug.onShaderError==`function`)e.debug.onShaderError(i,m,b,x);else{let e=Bc(i,b,`vertex`),n=Bc(i,x,`fragment`);H(`WebGLProgram: Shader Error `+i.getError()+` - VALIDATE_STATUS `+i.getProgramParameter(m,i.VALIDATE_STATUS)+`

Material Name: `+t.name+`
Material Type: `+t.type+`

Program Info Log: `+o+`
`+e+`
`+n)}}else o===``?(s===``||c===``)&&(u=!1):V(`WebGLProgram: Program Info Log:`,o);u&&(t.diagnostics={runnable:l,programLog:o,vertexShader:{log:s,prefix:h},fragmentShader:{log:c,prefix:g}})}i.deleteShader(b),i.deleteShader(x),C=new Nc(i,m),w=Jc(i,m)}let C;this.getUniforms=function(){return C===void 0&&S(this),C};let w;this.getAttributes=function(){return w===void 0&&S(this),w};let T=n.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return T===!1&&(T=i.getProgramParameter(m,Fc)),T},this.destroy=function(){r.releaseStatesOfProgram(this),i.deleteProgram(m),this.program=void 0},this.type=n.shaderType,this.name=n.shaderName,this.id=Ic++,this.cacheKey=t,this.usedTimes=1,this.program=m,this.vertexShader=b,this.fragmentShader=x,this}var fl=0,pl=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let r=this._getShaderCacheForMaterial(e);return r.has(t)===!1&&(r.add(t),t.usedTimes++),r.has(n)===!1&&(r.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let e of t)e.usedTimes--,e.usedTimes===0&&this.shaderCache.delete(e.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new ml(e),t.set(e,n)),n}},ml=class{constructor(e){this.id=fl++,this.code=e,this.usedTimes=0}};function hl(e){return e===1030||e===37490||e===36285}function gl(e,t,n,r,i,a){let o=new Fn,s=new pl,c=new Set,l=[],u=new Map,d=r.logarithmicDepthBuffer,f={MeshDepthMaterial:`depth`,MeshDistanceMaterial:`distance`,MeshNormalMaterial:`normal`,MeshBasicMaterial:`basic`,MeshLambertMaterial:`lambert`,MeshPhongMaterial:`phong`,MeshToonMaterial:`toon`,MeshStandardMaterial:`physical`,MeshPhysicalMaterial:`physical`,MeshMatcapMaterial:`matcap`,LineBasicMaterial:`basic`,LineDashedMaterial:`dashed`,PointsMaterial:`points`,ShadowMaterial:`shadow`,SpriteMaterial:`sprite`};function p(e){return c.add(e),e===0?`uv`:`uv${e}`}function m(i,o,l,u,m,h){let g=u.fog,_=m.geometry,v=i.isMeshStandardMaterial||i.isMeshLambertMaterial||i.isMeshPhongMaterial?u.environment:null,y=i.isMeshStandardMaterial||i.isMeshLambertMaterial&&!i.envMap||i.isMeshPhongMaterial&&!i.envMap,b=t.get(i.envMap||v,y),x=f[i.type],S=r.precision;i.precision!==null&&(S=r.getMaxPrecision(i.precision),S!==i.precision&&V(`WebGLProgram.getParameters:`,i.precision,`not supported, using`,S,`instead.`));let C=_.morphAttributes.position||_.morphAttributes.normal||_.morphAttributes.color,w=C===void 0?0:C.length,T=0;_.morphAttributes.position!==void 0&&(T=1),_.morphAttributes.normal!==void 0&&(T=2),_.morphAttributes.color!==void 0&&(T=3);let E,D,O,k;if(x){let e=Wo[x];E=e.vertexShader,D=e.fragmentShader}else{E=i.vertexShader,D=i.fragmentShader;let e=s.getVertexShaderStage(i),t=s.getFragmentShaderStage(i);s.update(i,e,t),O=e.id,k=t.id}let A=e.getRenderTarget(),j=e.state.buffers.depth.getReversed(),M=m.isInstancedMesh===!0,N=m.isBatchedMesh===!0,ee=!!i.map,te=!!i.matcap,P=!!b,ne=P&&b.isPMREMTexture===!0,re=!!i.aoMap,ie=!!i.lightMap,ae=!!i.bumpMap&&i.wireframe===!1,oe=!!i.normalMap,se=!!i.displacementMap,ce=!!i.emissiveMap,F=!!i.metalnessMap,I=!!i.roughnessMap,le=i.anisotropy>0,ue=i.clearcoat>0,de=i.diffuseRoughness>0,fe=i.dispersion>0,pe=i.retroreflectivity>0,me=i.iridescence>0,he=i.sheen>0,ge=i.transmission>0,_e=le&&!!i.anisotropyMap,ve=ue&&!!i.clearcoatMap,ye=ue&&!!i.clearcoatNormalMap,be=ue&&!!i.clearcoatRoughnessMap,xe=de&&!!i.diffuseRoughnessMap,Se=me&&!!i.iridescenceMap,Ce=me&&!!i.iridescenceThicknessMap,we=he&&!!i.sheenColorMap,Te=he&&!!i.sheenRoughnessMap,Ee=!!i.specularMap,De=!!i.specularColorMap,Oe=!!i.specularIntensityMap,ke=ge&&!!i.transmissionMap,Ae=ge&&!!i.thicknessMap,je=!!i.gradientMap,Me=!!i.alphaMap,L=i.alphaTest>0,Ne=!!i.alphaHash,Pe=!!i.extensions,Fe=0;i.toneMapped&&(A===null||A.isXRRenderTarget===!0)&&(Fe=e.toneMapping);let R=ne?b.isCompressedCubeTexture?b.image[0].mipmaps:b.mipmaps:null,Ie={shaderID:x,shaderType:i.type,shaderName:i.name,vertexShader:E,fragmentShader:D,defines:i.defines,customVertexShaderID:O,customFragmentShaderID:k,isRawShaderMaterial:i.isRawShaderMaterial===!0,glslVersion:i.glslVersion,precision:S,batching:N,batchingColor:N&&m._colorsTexture!==null,instancing:M,instancingColor:M&&m.instanceColor!==null,instancingMorph:M&&m.morphTexture!==null,outputColorSpace:A===null?e.outputColorSpace:A.isXRRenderTarget===!0?A.texture.colorSpace:q.workingColorSpace,alphaToCoverage:!!i.alphaToCoverage,map:ee,matcap:te,envMap:P,envMapMode:P&&b.mapping,envMapPMREM:ne,envMapMaxLod:ne?R.length-1:null,envMapSize:ne?R[0].width:null,aoMap:re,lightMap:ie,bumpMap:ae,normalMap:oe,displacementMap:se,emissiveMap:ce,normalMapObjectSpace:oe&&i.normalMapType===1,normalMapTangentSpace:oe&&i.normalMapType===0,packedNormalMap:oe&&i.normalMapType===0&&hl(i.normalMap.format),metalnessMap:F,roughnessMap:I,anisotropy:le,anisotropyMap:_e,clearcoat:ue,clearcoatMap:ve,clearcoatNormalMap:ye,clearcoatRoughnessMap:be,diffuseRoughness:de,diffuseRoughnessMap:xe,dispersion:fe,retroreflection:pe,iridescence:me,iridescenceMap:Se,iridescenceThicknessMap:Ce,sheen:he,sheenColorMap:we,sheenRoughnessMap:Te,specularMap:Ee,specularColorMap:De,specularIntensityMap:Oe,transmission:ge,transmissionMap:ke,thicknessMap:Ae,gradientMap:je,opaque:i.transparent===!1&&i.blending===1&&i.alphaToCoverage===!1,alphaMap:Me,alphaTest:L,alphaHash:Ne,combine:i.combine,mapUv:ee&&p(i.map.channel),aoMapUv:re&&p(i.aoMap.channel),lightMapUv:ie&&p(i.lightMap.channel),bumpMapUv:ae&&p(i.bumpMap.channel),normalMapUv:oe&&p(i.normalMap.channel),displacementMapUv:se&&p(i.displacementMap.channel),emissiveMapUv:ce&&p(i.emissiveMap.channel),metalnessMapUv:F&&p(i.metalnessMap.channel),roughnessMapUv:I&&p(i.roughnessMap.channel),anisotropyMapUv:_e&&p(i.anisotropyMap.channel),clearcoatMapUv:ve&&p(i.clearcoatMap.channel),clearcoatNormalMapUv:ye&&p(i.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:be&&p(i.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:xe&&p(i.diffuseRoughnessMap.channel),iridescenceMapUv:Se&&p(i.iridescenceMap.channel),iridescenceThicknessMapUv:Ce&&p(i.iridescenceThicknessMap.channel),sheenColorMapUv:we&&p(i.sheenColorMap.channel),sheenRoughnessMapUv:Te&&p(i.sheenRoughnessMap.channel),specularMapUv:Ee&&p(i.specularMap.channel),specularColorMapUv:De&&p(i.specularColorMap.channel),specularIntensityMapUv:Oe&&p(i.specularIntensityMap.channel),transmissionMapUv:ke&&p(i.transmissionMap.channel),thicknessMapUv:Ae&&p(i.thicknessMap.channel),alphaMapUv:Me&&p(i.alphaMap.channel),vertexTangents:!!_.attributes.tangent&&(oe||le),vertexNormals:!!_.attributes.normal,vertexColors:i.vertexColors,vertexAlphas:i.vertexColors===!0&&!!_.attributes.color&&_.attributes.color.itemSize===4,pointsUvs:m.isPoints===!0&&!!_.attributes.uv&&(ee||Me),fog:!!g,useFog:i.fog===!0,fogExp2:!!g&&g.isFogExp2,flatShading:i.wireframe===!1&&(i.flatShading===!0||_.attributes.normal===void 0&&oe===!1&&(i.isMeshLambertMaterial||i.isMeshPhongMaterial||i.isMeshStandardMaterial||i.isMeshPhysicalMaterial)),sizeAttenuation:i.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:j,skinning:m.isSkinnedMesh===!0,hasPositionAttribute:_.attributes.position!==void 0,morphTargets:_.morphAttributes.position!==void 0,morphNormals:_.morphAttributes.normal!==void 0,morphColors:_.morphAttributes.color!==void 0,morphTargetsCount:w,morphTextureStride:T,numSunLights:o.sun.length,numDirLights:o.directional.length,numPointLights:o.point.length,numSpotLights:o.spot.length,numSpotLightMaps:o.spotLightMap.length,numRectAreaLights:o.rectArea.length,numHemiLights:o.hemi.length,numSunLightShadows:o.sunShadowMap.length,numDirLightShadows:o.directionalShadowMap.length,numPointLightShadows:o.pointShadowMap.length,numSpotLightShadows:o.spotShadowMap.length,numSpotLightShadowsWithMaps:o.numSpotLightShadowsWithMaps,numLightProbes:o.numLightProbes,numLightProbeGrids:h.filter(e=>e.texture!==null).length,numClippingPlanes:a.numPlanes,numClipIntersection:a.numIntersection,dithering:i.dithering,shadowMapEnabled:e.shadowMap.enabled&&l.length>0,shadowMapType:e.shadowMap.type,toneMapping:Fe,decodeVideoTexture:ee&&i.map.isVideoTexture===!0&&q.getTransfer(i.map.colorSpace)===`srgb`,decodeVideoTextureEmissive:ce&&i.emissiveMap.isVideoTexture===!0&&q.getTransfer(i.emissiveMap.colorSpace)===`srgb`,premultipliedAlpha:i.premultipliedAlpha,doubleSided:i.side===2,flipSided:i.side===1,useDepthPacking:i.depthPacking>=0,depthPacking:i.depthPacking||0,index0AttributeName:i.index0AttributeName,extensionClipCullDistance:Pe&&i.extensions.clipCullDistance===!0&&n.has(`WEBGL_clip_cull_distance`),extensionMultiDraw:(Pe&&i.extensions.multiDraw===!0||N)&&n.has(`WEBGL_multi_draw`),rendererExtensionParallelShaderCompile:n.has(`KHR_parallel_shader_compile`),customProgramCacheKey:i.customProgramCacheKey()};return Ie.vertexUv1s=c.has(1),Ie.vertexUv2s=c.has(2),Ie.vertexUv3s=c.has(3),c.clear(),Ie}function h(t){let n=[];if(t.shaderID?n.push(t.shaderID):(n.push(t.customVertexShaderID),n.push(t.customFragmentShaderID)),t.defines!==void 0)for(let e in t.defines)n.push(e),n.push(t.defines[e]);return t.isRawShaderMaterial===!1&&(g(n,t),_(n,t),n.push(e.outputColorSpace)),n.push(t.customProgramCacheKey),n.join()}function g(e,t){e.push(t.precision),e.push(t.outputColorSpace),e.push(t.envMapMode),e.push(t.envMapPMREM),e.push(t.envMapMaxLod),e.push(t.envMapSize),e.push(t.mapUv),e.push(t.alphaMapUv),e.push(t.lightMapUv),e.push(t.aoMapUv),e.push(t.bumpMapUv),e.push(t.normalMapUv),e.push(t.displacementMapUv),e.push(t.emissiveMapUv),e.push(t.metalnessMapUv),e.push(t.roughnessMapUv),e.push(t.anisotropyMapUv),e.push(t.clearcoatMapUv),e.push(t.clearcoatNormalMapUv),e.push(t.clearcoatRoughnessMapUv),e.push(t.diffuseRoughnessMapUv),e.push(t.iridescenceMapUv),e.push(t.iridescenceThicknessMapUv),e.push(t.sheenColorMapUv),e.push(t.sheenRoughnessMapUv),e.push(t.specularMapUv),e.push(t.specularColorMapUv),e.push(t.specularIntensityMapUv),e.push(t.transmissionMapUv),e.push(t.thicknessMapUv),e.push(t.combine),e.push(t.fogExp2),e.push(t.sizeAttenuation),e.push(t.morphTargetsCount),e.push(t.numSunLights),e.push(t.numDirLights),e.push(t.numPointLights),e.push(t.numSpotLights),e.push(t.numSpotLightMaps),e.push(t.numHemiLights),e.push(t.numRectAreaLights),e.push(t.numSunLightShadows),e.push(t.numDirLightShadows),e.push(t.numPointLightShadows),e.push(t.numSpotLightShadows),e.push(t.numSpotLightShadowsWithMaps),e.push(t.numLightProbes),e.push(t.numLightProbeGrids),e.push(t.shadowMapType),e.push(t.toneMapping),e.push(t.numClippingPlanes),e.push(t.numClipIntersection),e.push(t.depthPacking)}function _(e,t){o.disableAll(),t.instancing&&o.enable(0),t.instancingColor&&o.enable(1),t.instancingMorph&&o.enable(2),t.matcap&&o.enable(3),t.envMap&&o.enable(4),t.normalMapObjectSpace&&o.enable(5),t.normalMapTangentSpace&&o.enable(6),t.clearcoat&&o.enable(7),t.iridescence&&o.enable(8),t.alphaTest&&o.enable(9),t.vertexColors&&o.enable(10),t.vertexAlphas&&o.enable(11),t.vertexUv1s&&o.enable(12),t.vertexUv2s&&o.enable(13),t.vertexUv3s&&o.enable(14),t.vertexTangents&&o.enable(15),t.anisotropy&&o.enable(16),t.alphaHash&&o.enable(17),t.batching&&o.enable(18),t.dispersion&&o.enable(19),t.retroreflection&&o.enable(24),t.diffuseRoughness&&o.enable(25),t.batchingColor&&o.enable(20),t.gradientMap&&o.enable(21),t.packedNormalMap&&o.enable(22),t.vertexNormals&&o.enable(23),e.push(o.mask),o.disableAll(),t.fog&&o.enable(0),t.useFog&&o.enable(1),t.flatShading&&o.enable(2),t.logarithmicDepthBuffer&&o.enable(3),t.reversedDepthBuffer&&o.enable(4),t.skinning&&o.enable(5),t.morphTargets&&o.enable(6),t.morphNormals&&o.enable(7),t.morphColors&&o.enable(8),t.premultipliedAlpha&&o.enable(9),t.shadowMapEnabled&&o.enable(10),t.doubleSided&&o.enable(11),t.flipSided&&o.enable(12),t.useDepthPacking&&o.enable(13),t.dithering&&o.enable(14),t.transmission&&o.enable(15),t.sheen&&o.enable(16),t.opaque&&o.enable(17),t.pointsUvs&&o.enable(18),t.decodeVideoTexture&&o.enable(19),t.decodeVideoTextureEmissive&&o.enable(20),t.alphaToCoverage&&o.enable(21),t.numLightProbeGrids>0&&o.enable(22),t.hasPositionAttribute&&o.enable(23),e.push(o.mask)}function v(e){let t=f[e.type],n;if(t){let e=Wo[t];n=ja.clone(e.uniforms)}else n=e.uniforms;return n}function y(t,n){let r=u.get(n);return r===void 0?(r=new dl(e,n,t,i),l.push(r),u.set(n,r)):++r.usedTimes,r}function b(e){if(--e.usedTimes===0){let t=l.indexOf(e);l[t]=l[l.length-1],l.pop(),u.delete(e.cacheKey),e.destroy()}}function x(e){s.remove(e)}function S(){s.dispose()}return{getParameters:m,getProgramCacheKey:h,getUniforms:v,acquireProgram:y,releaseProgram:b,releaseShaderCache:x,programs:l,dispose:S}}function _l(){let e=new WeakMap;function t(t){return e.has(t)}function n(t){let n=e.get(t);return n===void 0&&(n={},e.set(t,n)),n}function r(t){e.delete(t)}function i(t,n,r){e.get(t)[n]=r}function a(){e=new WeakMap}return{has:t,get:n,remove:r,update:i,dispose:a}}function vl(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.material.id===t.material.id?e.materialVariant===t.materialVariant?e.z===t.z?e.id-t.id:e.z-t.z:e.materialVariant-t.materialVariant:e.material.id-t.material.id:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function yl(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.z===t.z?e.id-t.id:t.z-e.z:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function bl(){let e=[],t=0,n=[],r=[],i=[];function a(){t=0,n.length=0,r.length=0,i.length=0}function o(e){let t=0;return e.isInstancedMesh&&(t+=2),e.isSkinnedMesh&&(t+=1),t}function s(n,r,i,a,s,c){let l=e[t];return l===void 0?(l={id:n.id,object:n,geometry:r,material:i,materialVariant:o(n),groupOrder:a,renderOrder:n.renderOrder,z:s,group:c},e[t]=l):(l.id=n.id,l.object=n,l.geometry=r,l.material=i,l.materialVariant=o(n),l.groupOrder=a,l.renderOrder=n.renderOrder,l.z=s,l.group=c),t++,l}function c(e,t,a,o,c,l,u){u.reversedDepth===!0&&(c=-c);let d=s(e,t,a,o,c,l);a.transmission>0?r.push(d):a.transparent===!0?i.push(d):n.push(d)}function l(e,t,a,o,c,l){let u=s(e,t,a,o,c,l);a.transmission>0?r.unshift(u):a.transparent===!0?i.unshift(u):n.unshift(u)}function u(e,t){n.length>1&&n.sort(e||vl),r.length>1&&r.sort(t||yl),i.length>1&&i.sort(t||yl)}function d(){for(let n=t,r=e.length;n<r;n++){let t=e[n];if(t.id===null)break;t.id=null,t.object=null,t.geometry=null,t.material=null,t.group=null}}return{opaque:n,transmissive:r,transparent:i,init:a,push:c,unshift:l,finish:d,sort:u}}function xl(){let e=new WeakMap;function t(t,n){let r=e.get(t),i;return r===void 0?(i=new bl,e.set(t,[i])):n>=r.length?(i=new bl,r.push(i)):i=r[n],i}function n(){e=new WeakMap}return{get:t,dispose:n}}function Sl(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={direction:new G,color:new X};break;case`SpotLight`:n={position:new G,direction:new G,color:new X,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case`PointLight`:n={position:new G,color:new X,distance:0,decay:0};break;case`HemisphereLight`:n={direction:new G,skyColor:new X,groundColor:new X};break;case`RectAreaLight`:n={color:new X,position:new G,halfWidth:new G,halfHeight:new G}}return e[t.id]=n,n}}}function Cl(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new W};break;case`SpotLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new W};break;case`PointLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new W,shadowCameraNear:1,shadowCameraFar:1e3}}return e[t.id]=n,n}}}var wl=0;function Tl(e,t){return(t.castShadow?2:0)-(e.castShadow?2:0)+ +!!t.map-!!e.map}function El(e){let t=new Sl,n=Cl(),r={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let e=0;e<9;e++)r.probe.push(new G);let i=new G,a=new Y,o=new Y;function s(i){let a=0,o=0,s=0;for(let e=0;e<9;e++)r.probe[e].set(0,0,0);let c=0,l=0,u=0,d=0,f=0,p=0,m=0,h=0,g=0,_=0,v=0,y=0,b=0,x=0;i.sort(Tl);for(let e=0,S=i.length;e<S;e++){let S=i[e],C=S.color,w=S.intensity,T=S.distance,E=null;if(S.shadow&&S.shadow.map&&(E=S.shadow.map.texture.format===1030?S.shadow.map.texture:S.shadow.map.depthTexture||S.shadow.map.texture),S.isAmbientLight)a+=C.r*w,o+=C.g*w,s+=C.b*w;else if(S.isLightProbe){for(let e=0;e<9;e++)r.probe[e].addScaledVector(S.sh.coefficients[e],w);x++}else if(S.isSunLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize.copy(e.mapSize).multiply(e.getFrameExtents()),r.sunShadow[l]=t,r.sunShadowMap[l]=E;let i=e.getViewportCount();for(let t=0;t<i;t++)r.sunShadowMatrix[u+t]=e.getMatrix(t),r.sunShadowCascade[u+t]=e._cascadeData[t];u+=i,l++}r.sun[c]=e,c++}else if(S.isDirectionalLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,r.directionalShadow[d]=t,r.directionalShadowMap[d]=E,r.directionalShadowMatrix[d]=S.shadow.matrix,g++}r.directional[d]=e,d++}else if(S.isSpotLight){let e=t.get(S);e.position.setFromMatrixPosition(S.matrixWorld),e.color.copy(C).multiplyScalar(w),e.distance=T,e.coneCos=Math.cos(S.angle),e.penumbraCos=Math.cos(S.angle*(1-S.penumbra)),e.decay=S.decay,r.spot[p]=e;let i=S.shadow;if(S.map&&(r.spotLightMap[y]=S.map,y++,i.updateMatrices(S),S.castShadow&&b++),r.spotLightMatrix[p]=i.matrix,S.castShadow){let e=n.get(S);e.shadowIntensity=i.intensity,e.shadowBias=i.bias,e.shadowNormalBias=i.normalBias,e.shadowRadius=i.radius,e.shadowMapSize=i.mapSize,r.spotShadow[p]=e,r.spotShadowMap[p]=E,v++}p++}else if(S.isRectAreaLight){let e=t.get(S);e.color.copy(C).multiplyScalar(w),e.halfWidth.set(S.width*.5,0,0),e.halfHeight.set(0,S.height*.5,0),r.rectArea[m]=e,m++}else if(S.isPointLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),e.distance=S.distance,e.decay=S.decay,S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,t.shadowCameraNear=e.camera.near,t.shadowCameraFar=e.camera.far,r.pointShadow[f]=t,r.pointShadowMap[f]=E,r.pointShadowMatrix[f]=S.shadow.matrix,_++}r.point[f]=e,f++}else if(S.isHemisphereLight){let e=t.get(S);e.skyColor.copy(S.color).multiplyScalar(w),e.groundColor.copy(S.groundColor).multiplyScalar(w),r.hemi[h]=e,h++}}m>0&&(e.has(`OES_texture_float_linear`)===!0?(r.rectAreaLTC1=Q.LTC_FLOAT_1,r.rectAreaLTC2=Q.LTC_FLOAT_2):(r.rectAreaLTC1=Q.LTC_HALF_1,r.rectAreaLTC2=Q.LTC_HALF_2)),r.ambient[0]=a,r.ambient[1]=o,r.ambient[2]=s;let S=r.hash;(S.sunLength!==c||S.directionalLength!==d||S.pointLength!==f||S.spotLength!==p||S.rectAreaLength!==m||S.hemiLength!==h||S.numSunShadows!==l||S.numDirectionalShadows!==g||S.numPointShadows!==_||S.numSpotShadows!==v||S.numSpotMaps!==y||S.numLightProbes!==x)&&(r.sun.length=c,r.directional.length=d,r.spot.length=p,r.rectArea.length=m,r.point.length=f,r.hemi.length=h,r.sunShadow.length=l,r.sunShadowMap.length=l,r.sunShadowMatrix.length=u,r.sunShadowCascade.length=u,r.directionalShadow.length=g,r.directionalShadowMap.length=g,r.directionalShadowMatrix.length=g,r.pointShadow.length=_,r.pointShadowMap.length=_,r.pointShadowMatrix.length=_,r.spotShadow.length=v,r.spotShadowMap.length=v,r.spotLightMatrix.length=v+y-b,r.spotLightMap.length=y,r.numSpotLightShadowsWithMaps=b,r.numLightProbes=x,S.sunLength=c,S.directionalLength=d,S.pointLength=f,S.spotLength=p,S.rectAreaLength=m,S.hemiLength=h,S.numSunShadows=l,S.numDirectionalShadows=g,S.numPointShadows=_,S.numSpotShadows=v,S.numSpotMaps=y,S.numLightProbes=x,r.version=wl++)}function c(e,t){let n=0,s=0,c=0,l=0,u=0,d=0,f=t.matrixWorldInverse;for(let t=0,p=e.length;t<p;t++){let p=e[t];if(p.isSunLight){let e=r.sun[n];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),n++}else if(p.isDirectionalLight){let e=r.directional[s];e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),s++}else if(p.isSpotLight){let e=r.spot[l];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),l++}else if(p.isRectAreaLight){let e=r.rectArea[u];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),o.identity(),a.copy(p.matrixWorld),a.premultiply(f),o.extractRotation(a),e.halfWidth.set(p.width*.5,0,0),e.halfHeight.set(0,p.height*.5,0),e.halfWidth.applyMatrix4(o),e.halfHeight.applyMatrix4(o),u++}else if(p.isPointLight){let e=r.point[c];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),c++}else if(p.isHemisphereLight){let e=r.hemi[d];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),d++}}}return{setup:s,setupView:c,state:r}}function Dl(e){let t=new El(e),n=[],r=[],i=[];function a(e){u.camera=e,n.length=0,r.length=0,i.length=0}function o(e){e.isLightProbeGrid?i.push(e):n.push(e)}function s(e){r.push(e)}function c(){t.setup(n),i.sort((e,t)=>e.priority-t.priority||e.id-t.id)}function l(e){t.setupView(n,e)}let u={lightsArray:n,shadowsArray:r,lightProbeGridArray:i,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:a,state:u,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:s}}function Ol(e){let t=new WeakMap;function n(n,r=0){let i=t.get(n),a;return i===void 0?(a=new Dl(e),t.set(n,[a])):r>=i.length?(a=new Dl(e),i.push(a)):a=i[r],a}function r(){t=new WeakMap}return{get:n,dispose:r}}var kl=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,Al=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,jl=[new G(1,0,0),new G(-1,0,0),new G(0,1,0),new G(0,-1,0),new G(0,0,1),new G(0,0,-1)],Ml=[new G(0,-1,0),new G(0,-1,0),new G(0,0,1),new G(0,0,-1),new G(0,-1,0),new G(0,-1,0)],Nl=new Y,Pl=new G,Fl=new G;function Il(e,t,n){let r=new Wi,i=new W,a=new W,o=new J,s=new Ia,c=new La,l={},u=n.maxTextureSize,d={0:1,1:0,2:2},f=new Pa({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new W},radius:{value:4}},vertexShader:kl,fragmentShader:Al}),p=f.clone();p.defines.HORIZONTAL_PASS=1;let m=new ei;m.setAttribute(`position`,new zr(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let h=new Oi(m,f),g=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=1;let _=this.type;this.render=function(t,n,s){if(g.enabled===!1||g.autoUpdate===!1&&g.needsUpdate===!1||t.length===0)return;this.type===2&&(V(`WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead.`),this.type=1);let c=e.getRenderTarget(),l=e.getActiveCubeFace(),d=e.getActiveMipmapLevel(),f=e.state;f.setBlending(0),f.buffers.depth.getReversed()===!0?f.buffers.color.setClear(0,0,0,0):f.buffers.color.setClear(1,1,1,1),f.buffers.depth.setTest(!0),f.setScissorTest(!1);let p=_!==this.type;p&&n.traverse(function(e){e.material&&(Array.isArray(e.material)?e.material.forEach(e=>e.needsUpdate=!0):e.material.needsUpdate=!0)});for(let c=0,l=t.length;c<l;c++){let l=t[c],d=l.shadow;if(d===void 0){V(`WebGLShadowMap:`,l,`has no shadow.`);continue}if(d.autoUpdate===!1&&d.needsUpdate===!1)continue;i.copy(d.mapSize);let m=d.getFrameExtents();i.multiply(m),a.copy(d.mapSize),(i.x>u||i.y>u)&&(i.x>u&&(a.x=Math.floor(u/m.x),i.x=a.x*m.x,d.mapSize.x=a.x),i.y>u&&(a.y=Math.floor(u/m.y),i.y=a.y*m.y,d.mapSize.y=a.y));let h=e.state.buffers.depth.getReversed();if(d.camera._reversedDepth=h,d.map===null||p===!0){if(d.map!==null&&(d.map.depthTexture!==null&&(d.map.depthTexture.dispose(),d.map.depthTexture=null),d.map.dispose()),this.type===3){if(l.isPointLight){V(`WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.`);continue}d.map=new Sn(i.x,i.y,{format:Se,type:le,minFilter:P,magFilter:P,generateMipmaps:!1}),d.map.texture.name=l.name+`.shadowMap`,d.map.depthTexture=new ma(i.x,i.y,I),d.map.depthTexture.name=l.name+`.shadowMapDepth`,d.map.depthTexture.format=ve,d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=N,d.map.depthTexture.magFilter=N}else l.isPointLight?(d.map=new $o(i.x),d.map.depthTexture=new ha(i.x,F)):(d.map=new Sn(i.x,i.y),d.map.depthTexture=new ma(i.x,i.y,F)),d.map.depthTexture.name=l.name+`.shadowMap`,d.map.depthTexture.format=ve,this.type===1?(d.map.depthTexture.compareFunction=h?518:515,d.map.depthTexture.minFilter=P,d.map.depthTexture.magFilter=P):(d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=N,d.map.depthTexture.magFilter=N);d.camera.updateProjectionMatrix()}d.map.isWebGLCubeRenderTarget!==!0&&(d.map.width!==i.x||d.map.height!==i.y)&&d.map.setSize(i.x,i.y);let g=d.map.isWebGLCubeRenderTarget?6:d.getViewportCount();l.isPointLight!==!0&&d.updateMatrices(l,s);let _=d.camera.layers.mask&4294967294?d.camera.layers:s.layers;for(let t=0;t<g;t++){let i=d.getCamera(t);if(l.isPointLight){let e=d.camera,n=d.matrix,r=l.distance||e.far;r!==e.far&&(e.far=r,e.updateProjectionMatrix()),Pl.setFromMatrixPosition(l.matrixWorld),e.position.copy(Pl),Fl.copy(e.position),Fl.add(jl[t]),e.up.copy(Ml[t]),e.lookAt(Fl),e.updateMatrixWorld(),n.makeTranslation(-Pl.x,-Pl.y,-Pl.z),Nl.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),d._frustum.setFromProjectionMatrix(Nl,e.coordinateSystem,e.reversedDepth)}if(d.map.isWebGLCubeRenderTarget)e.setRenderTarget(d.map,t),e.clear();else{t===0&&(e.setRenderTarget(d.map),e.clear());let n=d.getViewport(t);o.set(a.x*n.x,a.y*n.y,a.x*n.z,a.y*n.w),f.viewport(o)}r=d.getFrustum(t),b(n,s,i,l,_,this.type)}d.isPointLightShadow!==!0&&this.type===3&&v(d,s),d.needsUpdate=!1}_=this.type,g.needsUpdate=!1,e.setRenderTarget(c,l,d)};function v(n,r){let a=t.update(h);f.defines.VSM_SAMPLES!==n.blurSamples&&(f.defines.VSM_SAMPLES=n.blurSamples,p.defines.VSM_SAMPLES=n.blurSamples,f.needsUpdate=!0,p.needsUpdate=!0),n.mapPass===null?n.mapPass=new Sn(i.x,i.y,{format:Se,type:le}):(n.mapPass.width!==n.map.width||n.mapPass.height!==n.map.height)&&n.mapPass.setSize(n.map.width,n.map.height),f.uniforms.shadow_pass.value=n.map.depthTexture,f.uniforms.resolution.value.set(n.map.width,n.map.height),f.uniforms.radius.value=n.radius,e.setRenderTarget(n.mapPass),e.clear(),e.renderBufferDirect(r,null,a,f,h,null),p.uniforms.shadow_pass.value=n.mapPass.texture,p.uniforms.resolution.value.set(n.map.width,n.map.height),p.uniforms.radius.value=n.radius,e.setRenderTarget(n.map),e.clear(),e.renderBufferDirect(r,null,a,p,h,null)}function y(t,n,r,i){let a=null,o=r.isPointLight===!0?t.customDistanceMaterial:t.customDepthMaterial;if(o!==void 0)a=o;else if(a=r.isPointLight===!0?c:s,e.localClippingEnabled&&n.clipShadows===!0&&Array.isArray(n.clippingPlanes)&&n.clippingPlanes.length!==0||n.displacementMap&&n.displacementScale!==0||n.alphaMap&&n.alphaTest>0||n.map&&n.alphaTest>0||n.alphaToCoverage===!0){let e=a.uuid,t=n.uuid,r=l[e];r===void 0&&(r={},l[e]=r);let i=r[t];i===void 0&&(i=a.clone(),r[t]=i,n.addEventListener(`dispose`,x)),a=i}if(a.visible=n.visible,a.wireframe=n.wireframe,i===3?a.side=n.shadowSide===null?n.side:n.shadowSide:a.side=n.shadowSide===null?d[n.side]:n.shadowSide,a.alphaMap=n.alphaMap,a.alphaTest=n.alphaToCoverage===!0?.5:n.alphaTest,a.map=n.map,a.clipShadows=n.clipShadows,a.clippingPlanes=n.clippingPlanes,a.clipIntersection=n.clipIntersection,a.displacementMap=n.displacementMap,a.displacementScale=n.displacementScale,a.displacementBias=n.displacementBias,a.wireframeLinewidth=n.wireframeLinewidth,a.linewidth=n.linewidth,r.isPointLight===!0&&a.isMeshDistanceMaterial===!0){let t=e.properties.get(a);t.light=r}return a}function b(n,i,a,o,s,c){if(n.visible===!1)return;if(n.layers.test(s)&&(n.isMesh||n.isLine||n.isPoints)&&(n.castShadow||n.receiveShadow&&c===3)&&(!n.frustumCulled||n.intersectsFrustum(r))){n.modelViewMatrix.multiplyMatrices(a.matrixWorldInverse,n.matrixWorld);let r=t.update(n),s=n.material;if(Array.isArray(s)){let t=r.groups;for(let l=0,u=t.length;l<u;l++){let u=t[l],d=s[u.materialIndex];if(d&&d.visible){let t=y(n,d,o,c);n.onBeforeShadow(e,n,i,a,r,t,u),e.renderBufferDirect(a,null,r,t,n,u),n.onAfterShadow(e,n,i,a,r,t,u)}}}else if(s.visible){let t=y(n,s,o,c);n.onBeforeShadow(e,n,i,a,r,t,null),e.renderBufferDirect(a,null,r,t,n,null),n.onAfterShadow(e,n,i,a,r,t,null)}}let l=n.children;for(let e=0,t=l.length;e<t;e++)b(l[e],i,a,o,s,c)}function x(e){e.target.removeEventListener(`dispose`,x);for(let t in l){let n=l[t],r=e.target.uuid;r in n&&(n[r].dispose(),delete n[r])}}}function Ll(e,t){function n(){let t=!1,n=new J,r=null,i=new J(0,0,0,0);return{setMask:function(n){r!==n&&!t&&(e.colorMask(n,n,n,n),r=n)},setLocked:function(e){t=e},setClear:function(t,r,a,o,s){s===!0&&(t*=o,r*=o,a*=o),n.set(t,r,a,o),i.equals(n)===!1&&(e.clearColor(t,r,a,o),i.copy(n))},reset:function(){t=!1,r=null,i.set(-1,0,0,0)}}}function r(){let n=!1,r=!1,i=null,a=null,o=null;return{setReversed:function(e){if(r!==e){let n=t.get(`EXT_clip_control`);e?n.clipControlEXT(n.LOWER_LEFT_EXT,n.ZERO_TO_ONE_EXT):n.clipControlEXT(n.LOWER_LEFT_EXT,n.NEGATIVE_ONE_TO_ONE_EXT),r=e;let i=o;o=null,this.setClear(i)}},getReversed:function(){return r},setTest:function(t){t?F(e.DEPTH_TEST):I(e.DEPTH_TEST)},setMask:function(t){i!==t&&!n&&(e.depthMask(t),i=t)},setFunc:function(t){if(r&&(t=Ot[t]),a!==t){switch(t){case 0:e.depthFunc(e.NEVER);break;case 1:e.depthFunc(e.ALWAYS);break;case 2:e.depthFunc(e.LESS);break;case 3:e.depthFunc(e.LEQUAL);break;case 4:e.depthFunc(e.EQUAL);break;case 5:e.depthFunc(e.GEQUAL);break;case 6:e.depthFunc(e.GREATER);break;case 7:e.depthFunc(e.NOTEQUAL);break;default:e.depthFunc(e.LEQUAL)}a=t}},setLocked:function(e){n=e},setClear:function(t){o!==t&&(o=t,r&&(t=1-t),e.clearDepth(t))},reset:function(){n=!1,i=null,a=null,o=null,r=!1}}}function i(){let t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null;return{setTest:function(n){t||(n?F(e.STENCIL_TEST):I(e.STENCIL_TEST))},setMask:function(r){n!==r&&!t&&(e.stencilMask(r),n=r)},setFunc:function(t,n,o){(r!==t||i!==n||a!==o)&&(e.stencilFunc(t,n,o),r=t,i=n,a=o)},setOp:function(t,n,r){(o!==t||s!==n||c!==r)&&(e.stencilOp(t,n,r),o=t,s=n,c=r)},setLocked:function(e){t=e},setClear:function(t){l!==t&&(e.clearStencil(t),l=t)},reset:function(){t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null}}}let a=new n,o=new r,s=new i,c={},l=new WeakMap,u={},d={},f={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new X(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,M=e.getParameter(e.MAX_COMBINED_TEXTURE_IMAGE_UNITS),N=!1,ee=0,te=e.getParameter(e.VERSION);te.indexOf(`WebGL`)===-1?te.indexOf(`OpenGL ES`)!==-1&&(ee=parseFloat(/^OpenGL ES (\d)/.exec(te)[1]),N=ee>=2):(ee=parseFloat(/^WebGL (\d)/.exec(te)[1]),N=ee>=1);let P=null,ne={},re=e.getParameter(e.SCISSOR_BOX),ie=e.getParameter(e.VIEWPORT),ae=new J().fromArray(re),oe=new J().fromArray(ie);function se(t,n,r,i){let a=new Uint8Array(4),o=e.createTexture();e.bindTexture(t,o),e.texParameteri(t,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(t,e.TEXTURE_MAG_FILTER,e.NEAREST);for(let o=0;o<r;o++)t===e.TEXTURE_3D||t===e.TEXTURE_2D_ARRAY?e.texImage3D(n,0,e.RGBA,1,1,i,0,e.RGBA,e.UNSIGNED_BYTE,a):e.texImage2D(n+o,0,e.RGBA,1,1,0,e.RGBA,e.UNSIGNED_BYTE,a);return o}let ce={};ce[e.TEXTURE_2D]=se(e.TEXTURE_2D,e.TEXTURE_2D,1),ce[e.TEXTURE_CUBE_MAP]=se(e.TEXTURE_CUBE_MAP,e.TEXTURE_CUBE_MAP_POSITIVE_X,6),ce[e.TEXTURE_2D_ARRAY]=se(e.TEXTURE_2D_ARRAY,e.TEXTURE_2D_ARRAY,1,1),ce[e.TEXTURE_3D]=se(e.TEXTURE_3D,e.TEXTURE_3D,1,1),a.setClear(0,0,0,1),o.setClear(1),s.setClear(0),F(e.DEPTH_TEST),o.setFunc(3),ge(!1),_e(1),F(e.CULL_FACE),me(0);function F(t){u[t]!==!0&&(e.enable(t),u[t]=!0)}function I(t){u[t]!==!1&&(e.disable(t),u[t]=!1)}function le(t,n){return f[t]!==n&&(e.bindFramebuffer(t,n),f[t]=n,t===e.DRAW_FRAMEBUFFER&&(f[e.FRAMEBUFFER]=n),t===e.FRAMEBUFFER&&(f[e.DRAW_FRAMEBUFFER]=n),!0)}function ue(t,n){let r=m,i=!1;if(t){r=p.get(n),r===void 0&&(r=[],p.set(n,r));let a=t.textures;if(r.length!==a.length||r[0]!==e.COLOR_ATTACHMENT0){for(let t=0,n=a.length;t<n;t++)r[t]=e.COLOR_ATTACHMENT0+t;r.length=a.length,i=!0}}else r[0]!==e.BACK&&(r[0]=e.BACK,i=!0);i&&e.drawBuffers(r)}function de(t){return h!==t&&(e.useProgram(t),h=t,!0)}let fe={100:e.FUNC_ADD,101:e.FUNC_SUBTRACT,102:e.FUNC_REVERSE_SUBTRACT};fe[103]=e.MIN,fe[104]=e.MAX;let pe={200:e.ZERO,201:e.ONE,202:e.SRC_COLOR,204:e.SRC_ALPHA,210:e.SRC_ALPHA_SATURATE,208:e.DST_COLOR,206:e.DST_ALPHA,203:e.ONE_MINUS_SRC_COLOR,205:e.ONE_MINUS_SRC_ALPHA,209:e.ONE_MINUS_DST_COLOR,207:e.ONE_MINUS_DST_ALPHA,211:e.CONSTANT_COLOR,212:e.ONE_MINUS_CONSTANT_COLOR,213:e.CONSTANT_ALPHA,214:e.ONE_MINUS_CONSTANT_ALPHA};function me(t,n,r,i,a,o,s,c,l,u){if(t===0)g===!0&&(I(e.BLEND),g=!1);else if(g===!1&&(F(e.BLEND),g=!0),t!==5){if(t!==_||u!==E){if((v!==100||x!==100)&&(e.blendEquation(e.FUNC_ADD),v=100,x=100),u)switch(t){case 1:e.blendFuncSeparate(e.ONE,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFunc(e.ONE,e.ONE);break;case 3:e.blendFuncSeparate(e.ZERO,e.ONE_MINUS_SRC_COLOR,e.ZERO,e.ONE);break;case 4:e.blendFuncSeparate(e.DST_COLOR,e.ONE_MINUS_SRC_ALPHA,e.ZERO,e.ONE);break;default:H(`WebGLState: Invalid blending: `,t)}else switch(t){case 1:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ONE,e.ONE);break;case 3:H(`WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true`);break;case 4:H(`WebGLState: MultiplyBlending requires material.premultipliedAlpha = true`);break;default:H(`WebGLState: Invalid blending: `,t)}y=null,b=null,S=null,C=null,w.set(0,0,0),T=0,_=t,E=u}}else a||=n,o||=r,s||=i,(n!==v||a!==x)&&(e.blendEquationSeparate(fe[n],fe[a]),v=n,x=a),(r!==y||i!==b||o!==S||s!==C)&&(e.blendFuncSeparate(pe[r],pe[i],pe[o],pe[s]),y=r,b=i,S=o,C=s),(c.equals(w)===!1||l!==T)&&(e.blendColor(c.r,c.g,c.b,l),w.copy(c),T=l),_=t,E=!1}function he(t,n){t.side===2?I(e.CULL_FACE):F(e.CULL_FACE);let r=t.side===1;n&&(r=!r),ge(r),t.blending===1&&t.transparent===!1?me(0):me(t.blending,t.blendEquation,t.blendSrc,t.blendDst,t.blendEquationAlpha,t.blendSrcAlpha,t.blendDstAlpha,t.blendColor,t.blendAlpha,t.premultipliedAlpha),o.setFunc(t.depthFunc),o.setTest(t.depthTest),o.setMask(t.depthWrite),a.setMask(t.colorWrite);let i=t.stencilWrite;s.setTest(i),i&&(s.setMask(t.stencilWriteMask),s.setFunc(t.stencilFunc,t.stencilRef,t.stencilFuncMask),s.setOp(t.stencilFail,t.stencilZFail,t.stencilZPass)),ye(t.polygonOffset,t.polygonOffsetFactor,t.polygonOffsetUnits),t.alphaToCoverage===!0?F(e.SAMPLE_ALPHA_TO_COVERAGE):I(e.SAMPLE_ALPHA_TO_COVERAGE)}function ge(t){D!==t&&(t?e.frontFace(e.CW):e.frontFace(e.CCW),D=t)}function _e(t){t===0?I(e.CULL_FACE):(F(e.CULL_FACE),t!==O&&(t===1?e.cullFace(e.BACK):t===2?e.cullFace(e.FRONT):e.cullFace(e.FRONT_AND_BACK))),O=t}function ve(t){t!==k&&(N&&e.lineWidth(t),k=t)}function ye(t,n,r){t?(F(e.POLYGON_OFFSET_FILL),(A!==n||j!==r)&&(A=n,j=r,o.getReversed()&&(n=-n,r=-r),e.polygonOffset(n,r))):I(e.POLYGON_OFFSET_FILL)}function be(t){t?F(e.SCISSOR_TEST):I(e.SCISSOR_TEST)}function xe(t){t===void 0&&(t=e.TEXTURE0+M-1),P!==t&&(e.activeTexture(t),P=t)}function Se(t,n,r){r===void 0&&(r=P===null?e.TEXTURE0+M-1:P);let i=ne[r];i===void 0&&(i={type:void 0,texture:void 0},ne[r]=i),(i.type!==t||i.texture!==n)&&(P!==r&&(e.activeTexture(r),P=r),e.bindTexture(t,n||ce[t]),i.type=t,i.texture=n)}function Ce(){let t=ne[P];t!==void 0&&t.type!==void 0&&(e.bindTexture(t.type,null),t.type=void 0,t.texture=void 0)}function we(){try{e.compressedTexImage2D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Te(){try{e.compressedTexImage3D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Ee(){try{e.texSubImage2D(...arguments)}catch(e){H(`WebGLState:`,e)}}function De(){try{e.texSubImage3D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Oe(){try{e.compressedTexSubImage2D(...arguments)}catch(e){H(`WebGLState:`,e)}}function ke(){try{e.compressedTexSubImage3D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Ae(){try{e.texStorage2D(...arguments)}catch(e){H(`WebGLState:`,e)}}function je(){try{e.texStorage3D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Me(){try{e.texImage2D(...arguments)}catch(e){H(`WebGLState:`,e)}}function L(){try{e.texImage3D(...arguments)}catch(e){H(`WebGLState:`,e)}}function Ne(t){return d[t]===void 0?e.getParameter(t):d[t]}function Pe(t,n){d[t]!==n&&(e.pixelStorei(t,n),d[t]=n)}function Fe(t){ae.equals(t)===!1&&(e.scissor(t.x,t.y,t.z,t.w),ae.copy(t))}function R(t){oe.equals(t)===!1&&(e.viewport(t.x,t.y,t.z,t.w),oe.copy(t))}function Ie(t,n){let r=l.get(n);r===void 0&&(r=new WeakMap,l.set(n,r));let i=r.get(t);i===void 0&&(i=e.getUniformBlockIndex(n,t.name),e.uniformBlockBinding(n,i,i),r.set(t,i))}function z(t,n,r){let i=l.get(n).get(t);c[i]!==r&&(e.bindBufferBase(e.UNIFORM_BUFFER,i,r),c[i]=r)}function B(){e.disable(e.BLEND),e.disable(e.CULL_FACE),e.disable(e.DEPTH_TEST),e.disable(e.POLYGON_OFFSET_FILL),e.disable(e.SCISSOR_TEST),e.disable(e.STENCIL_TEST),e.disable(e.SAMPLE_ALPHA_TO_COVERAGE),e.blendEquation(e.FUNC_ADD),e.blendFunc(e.ONE,e.ZERO),e.blendFuncSeparate(e.ONE,e.ZERO,e.ONE,e.ZERO),e.blendColor(0,0,0,0),e.colorMask(!0,!0,!0,!0),e.clearColor(0,0,0,0),e.depthMask(!0),e.depthFunc(e.LESS),o.setReversed(!1),e.clearDepth(1),e.stencilMask(4294967295),e.stencilFunc(e.ALWAYS,0,4294967295),e.stencilOp(e.KEEP,e.KEEP,e.KEEP),e.clearStencil(0),e.cullFace(e.BACK),e.frontFace(e.CCW),e.polygonOffset(0,0),e.activeTexture(e.TEXTURE0),e.bindFramebuffer(e.FRAMEBUFFER,null),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),e.bindFramebuffer(e.READ_FRAMEBUFFER,null),e.useProgram(null),e.lineWidth(1),e.scissor(0,0,e.canvas.width,e.canvas.height),e.viewport(0,0,e.canvas.width,e.canvas.height),e.pixelStorei(e.PACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!1),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.BROWSER_DEFAULT_WEBGL),e.pixelStorei(e.PACK_ROW_LENGTH,0),e.pixelStorei(e.PACK_SKIP_PIXELS,0),e.pixelStorei(e.PACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_ROW_LENGTH,0),e.pixelStorei(e.UNPACK_IMAGE_HEIGHT,0),e.pixelStorei(e.UNPACK_SKIP_PIXELS,0),e.pixelStorei(e.UNPACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_SKIP_IMAGES,0),u={},d={},P=null,ne={},f={},c={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new X(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,ae.set(0,0,e.canvas.width,e.canvas.height),oe.set(0,0,e.canvas.width,e.canvas.height),a.reset(),o.reset(),s.reset()}return{buffers:{color:a,depth:o,stencil:s},enable:F,disable:I,bindFramebuffer:le,drawBuffers:ue,useProgram:de,setBlending:me,setMaterial:he,setFlipSided:ge,setCullFace:_e,setLineWidth:ve,setPolygonOffset:ye,setScissorTest:be,activeTexture:xe,bindTexture:Se,unbindTexture:Ce,compressedTexImage2D:we,compressedTexImage3D:Te,texImage2D:Me,texImage3D:L,pixelStorei:Pe,getParameter:Ne,updateUBOMapping:Ie,uniformBlockBinding:z,texStorage2D:Ae,texStorage3D:je,texSubImage2D:Ee,texSubImage3D:De,compressedTexSubImage2D:Oe,compressedTexSubImage3D:ke,scissor:Fe,viewport:R,reset:B}}function Rl(e,t,n,r,i,a,o){let s=t.has(`WEBGL_multisampled_render_to_texture`)?t.get(`WEBGL_multisampled_render_to_texture`):null,c=typeof navigator>`u`?!1:/OculusBrowser/g.test(navigator.userAgent),l=new W,u=new WeakMap,d=new Set,f,p=new WeakMap,m=new Set,h=new FinalizationRegistry(e=>m.delete(e)),g=!1;try{g=typeof OffscreenCanvas<`u`&&new OffscreenCanvas(1,1).getContext(`2d`)!==null}catch{}function _(e,t){return g?new OffscreenCanvas(e,t):xt(`canvas`)}function v(e,t,n){let r=1,i=B(e);if((i.width>n||i.height>n)&&(r=n/Math.max(i.width,i.height)),r<1){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof VideoFrame<`u`&&e instanceof VideoFrame){let n=Math.floor(r*i.width),a=Math.floor(r*i.height);f===void 0&&(f=_(n,a));let o=t?_(n,a):f;return o.width=n,o.height=a,o.getContext(`2d`).drawImage(e,0,0,n,a),V(`WebGLRenderer: Texture has been resized from (`+i.width+`x`+i.height+`) to (`+n+`x`+a+`).`),o}return`data`in e&&V(`WebGLRenderer: Image in DataTexture is too big (`+i.width+`x`+i.height+`).`),e}return e}function y(e){return e.generateMipmaps}function b(t){e.generateMipmap(t)}function x(t){return t.isWebGLCubeRenderTarget?e.TEXTURE_CUBE_MAP:t.isWebGL3DRenderTarget?e.TEXTURE_3D:t.isWebGLArrayRenderTarget||t.isCompressedArrayTexture?e.TEXTURE_2D_ARRAY:e.TEXTURE_2D}function S(n,r,i,a,o,s=!1){if(n!==null){if(e[n]!==void 0)return e[n];V(`WebGLRenderer: Attempt to use non-existing WebGL internal format '`+n+`'`)}let c;a&&(c=t.get(`EXT_texture_norm16`),c||V(`WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension`));let l=r;if(r===e.RED&&(i===e.FLOAT&&(l=e.R32F),i===e.HALF_FLOAT&&(l=e.R16F),i===e.UNSIGNED_BYTE&&(l=e.R8),i===e.UNSIGNED_SHORT&&c&&(l=c.R16_EXT),i===e.SHORT&&c&&(l=c.R16_SNORM_EXT)),r===e.RED_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.R8UI),i===e.UNSIGNED_SHORT&&(l=e.R16UI),i===e.UNSIGNED_INT&&(l=e.R32UI),i===e.BYTE&&(l=e.R8I),i===e.SHORT&&(l=e.R16I),i===e.INT&&(l=e.R32I)),r===e.RG&&(i===e.FLOAT&&(l=e.RG32F),i===e.HALF_FLOAT&&(l=e.RG16F),i===e.UNSIGNED_BYTE&&(l=e.RG8),i===e.UNSIGNED_SHORT&&c&&(l=c.RG16_EXT),i===e.SHORT&&c&&(l=c.RG16_SNORM_EXT)),r===e.RG_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RG8UI),i===e.UNSIGNED_SHORT&&(l=e.RG16UI),i===e.UNSIGNED_INT&&(l=e.RG32UI),i===e.BYTE&&(l=e.RG8I),i===e.SHORT&&(l=e.RG16I),i===e.INT&&(l=e.RG32I)),r===e.RGB_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGB8UI),i===e.UNSIGNED_SHORT&&(l=e.RGB16UI),i===e.UNSIGNED_INT&&(l=e.RGB32UI),i===e.BYTE&&(l=e.RGB8I),i===e.SHORT&&(l=e.RGB16I),i===e.INT&&(l=e.RGB32I)),r===e.RGBA_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGBA8UI),i===e.UNSIGNED_SHORT&&(l=e.RGBA16UI),i===e.UNSIGNED_INT&&(l=e.RGBA32UI),i===e.BYTE&&(l=e.RGBA8I),i===e.SHORT&&(l=e.RGBA16I),i===e.INT&&(l=e.RGBA32I)),r===e.RGB&&(i===e.UNSIGNED_SHORT&&c&&(l=c.RGB16_EXT),i===e.SHORT&&c&&(l=c.RGB16_SNORM_EXT),i===e.UNSIGNED_INT_5_9_9_9_REV&&(l=e.RGB9_E5),i===e.UNSIGNED_INT_10F_11F_11F_REV&&(l=e.R11F_G11F_B10F)),r===e.RGBA){let t=s?pt:q.getTransfer(o);i===e.FLOAT&&(l=e.RGBA32F),i===e.HALF_FLOAT&&(l=e.RGBA16F),i===e.UNSIGNED_BYTE&&(l=t===`srgb`?e.SRGB8_ALPHA8:e.RGBA8),i===e.UNSIGNED_SHORT&&c&&(l=c.RGBA16_EXT),i===e.SHORT&&c&&(l=c.RGBA16_SNORM_EXT),i===e.UNSIGNED_SHORT_4_4_4_4&&(l=e.RGBA4),i===e.UNSIGNED_SHORT_5_5_5_1&&(l=e.RGB5_A1)}return(l===e.R16F||l===e.R32F||l===e.RG16F||l===e.RG32F||l===e.RGBA16F||l===e.RGBA32F)&&t.get(`EXT_color_buffer_float`),l}function C(t,n){let r;return t?n===null||n===1014||n===1020?r=e.DEPTH24_STENCIL8:n===1015?r=e.DEPTH32F_STENCIL8:n===1012&&(r=e.DEPTH24_STENCIL8,V(`DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.`)):n===null||n===1014||n===1020?r=e.DEPTH_COMPONENT24:n===1015?r=e.DEPTH_COMPONENT32F:n===1012&&(r=e.DEPTH_COMPONENT16),r}function w(e,t){return y(e)===!0||e.isFramebufferTexture&&e.minFilter!==1003&&e.minFilter!==1006?Math.log2(Math.max(t.width,t.height))+1:e.mipmaps.length>0?e.mipmaps.length:e.isCompressedTexture&&Array.isArray(e.image)?t.mipmaps.length:1}function T(e){let t=new WeakRef(e);r.get(e).__ref=t,m.add(t),h.register(e,t,t)}function E(e){let t=r.get(e).__ref;t!==void 0&&(m.delete(t),h.unregister(t))}function D(e){k(e.target)}function O(e){ie(e.target)}function k(e){e.removeEventListener(`dispose`,D),E(e),oe(e),e.isVideoTexture&&u.delete(e),e.isHTMLTexture&&d.delete(e)}function ie(e){e.removeEventListener(`dispose`,O),E(e),ce(e)}function ae(){for(let e of m){let t=e.deref();t!==void 0&&(t.isRenderTarget===!0?ie(t):k(t))}m.clear(),d.clear()}function oe(e){let t=r.get(e);if(t.__webglInit===void 0)return;let n=e.source,i=p.get(n);if(i){let r=i[t.__cacheKey];r.usedTimes--,r.usedTimes===0&&se(e),Object.keys(i).length===0&&p.delete(n)}r.remove(e)}function se(t){let n=r.get(t);e.deleteTexture(n.__webglTexture);let i=t.source,a=p.get(i);delete a[n.__cacheKey],o.memory.textures--}function ce(t){let n=r.get(t);n.__depthDisposeCallback&&n.__depthDisposeCallback();let i=t.depthTexture;if(i&&i.renderTarget===t&&k(i),t.isWebGLCubeRenderTarget)for(let t=0;t<6;t++){if(Array.isArray(n.__webglFramebuffer[t]))for(let r=0;r<n.__webglFramebuffer[t].length;r++)e.deleteFramebuffer(n.__webglFramebuffer[t][r]);else e.deleteFramebuffer(n.__webglFramebuffer[t]);n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer[t])}else{if(Array.isArray(n.__webglFramebuffer))for(let t=0;t<n.__webglFramebuffer.length;t++)e.deleteFramebuffer(n.__webglFramebuffer[t]);else e.deleteFramebuffer(n.__webglFramebuffer);if(n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer),n.__webglMultisampledFramebuffer&&e.deleteFramebuffer(n.__webglMultisampledFramebuffer),n.__webglColorRenderbuffer)for(let t=0;t<n.__webglColorRenderbuffer.length;t++)n.__webglColorRenderbuffer[t]&&e.deleteRenderbuffer(n.__webglColorRenderbuffer[t]);n.__webglDepthRenderbuffer&&e.deleteRenderbuffer(n.__webglDepthRenderbuffer)}let a=t.textures;for(let t=0,n=a.length;t<n;t++){let n=r.get(a[t]);n.__webglTexture&&(e.deleteTexture(n.__webglTexture),o.memory.textures--),r.remove(a[t])}r.remove(t)}let F=0;function I(){F=0}function le(){return F}function ue(e){F=e}function de(){let e=F;return e>=i.maxTextures&&V(`WebGLTextures: Trying to use `+(e+1)+` texture units while this GPU supports only `+i.maxTextures),F+=1,e}function fe(e){let t=[];return t.push(e.wrapS),t.push(e.wrapT),t.push(e.wrapR||0),t.push(e.magFilter),t.push(e.minFilter),t.push(e.anisotropy),t.push(e.internalFormat),t.push(e.format),t.push(e.type),t.push(e.generateMipmaps),t.push(e.mipmapsAutoUpdate),t.push(e.premultiplyAlpha),t.push(e.flipY),t.push(e.unpackAlignment),t.push(e.colorSpace),t.join()}function pe(t,i){let a=r.get(t);if(t.isVideoTexture&&Ie(t),t.isRenderTargetTexture===!1&&t.isExternalTexture!==!0&&t.version>0&&a.__version!==t.version){let e=t.image;if(e===null)V(`WebGLRenderer: Texture marked for update but no image data found.`);else if(e.complete===!1)V(`WebGLRenderer: Texture marked for update but image is incomplete`);else{Te(a,t,i);return}}else t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null);n.bindTexture(e.TEXTURE_2D,a.__webglTexture,e.TEXTURE0+i)}function me(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?Te(a,t,i):(t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null),n.bindTexture(e.TEXTURE_2D_ARRAY,a.__webglTexture,e.TEXTURE0+i))}function he(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?Te(a,t,i):n.bindTexture(e.TEXTURE_3D,a.__webglTexture,e.TEXTURE0+i)}function ge(t,i){let a=r.get(t);t.version>0&&a.__version!==t.version?Ee(a,t,i):n.bindTexture(e.TEXTURE_CUBE_MAP,a.__webglTexture,e.TEXTURE0+i)}let _e={[A]:e.REPEAT,[j]:e.CLAMP_TO_EDGE,[M]:e.MIRRORED_REPEAT},ve={[N]:e.NEAREST,[ee]:e.NEAREST_MIPMAP_NEAREST,[te]:e.NEAREST_MIPMAP_LINEAR,[P]:e.LINEAR,[ne]:e.LINEAR_MIPMAP_NEAREST,[re]:e.LINEAR_MIPMAP_LINEAR},be={512:e.NEVER,519:e.ALWAYS,513:e.LESS,515:e.LEQUAL,514:e.EQUAL,518:e.GEQUAL,516:e.GREATER,517:e.NOTEQUAL};function xe(n,a){if(a.type===1015&&t.has(`OES_texture_float_linear`)===!1&&(a.magFilter===1006||a.magFilter===1007||a.magFilter===1005||a.magFilter===1008||a.minFilter===1006||a.minFilter===1007||a.minFilter===1005||a.minFilter===1008)&&V(`WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device.`),e.texParameteri(n,e.TEXTURE_WRAP_S,_e[a.wrapS]),e.texParameteri(n,e.TEXTURE_WRAP_T,_e[a.wrapT]),(n===e.TEXTURE_3D||n===e.TEXTURE_2D_ARRAY)&&e.texParameteri(n,e.TEXTURE_WRAP_R,_e[a.wrapR]),e.texParameteri(n,e.TEXTURE_MAG_FILTER,ve[a.magFilter]),e.texParameteri(n,e.TEXTURE_MIN_FILTER,ve[a.minFilter]),a.compareFunction&&(e.texParameteri(n,e.TEXTURE_COMPARE_MODE,e.COMPARE_REF_TO_TEXTURE),e.texParameteri(n,e.TEXTURE_COMPARE_FUNC,be[a.compareFunction])),t.has(`EXT_texture_filter_anisotropic`)===!0){if(a.magFilter===1003||a.minFilter!==1005&&a.minFilter!==1008||a.type===1015&&t.has(`OES_texture_float_linear`)===!1)return;if(a.anisotropy>1||r.get(a).__currentAnisotropy){let o=t.get(`EXT_texture_filter_anisotropic`);e.texParameterf(n,o.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(a.anisotropy,i.getMaxAnisotropy())),r.get(a).__currentAnisotropy=a.anisotropy}}}function Se(t,n){let r=!1;t.__webglInit===void 0&&(t.__webglInit=!0,n.addEventListener(`dispose`,D),T(n));let i=n.source,a=p.get(i);a===void 0&&(a={},p.set(i,a));let s=fe(n);if(s!==t.__cacheKey){a[s]===void 0&&(a[s]={texture:e.createTexture(),usedTimes:0},o.memory.textures++,r=!0),a[s].usedTimes++;let i=a[t.__cacheKey];i!==void 0&&(a[t.__cacheKey].usedTimes--,i.usedTimes===0&&se(n)),t.__cacheKey=s,t.__webglTexture=a[s].texture}return r}function Ce(e,t,n){return Math.floor(Math.floor(e/n)/t)}function we(t,r,i,a){let o=t.updateRanges;if(o.length===0)n.texSubImage2D(e.TEXTURE_2D,0,0,0,r.width,r.height,i,a,r.data);else{o.sort((e,t)=>e.start-t.start);let s=0;for(let e=1;e<o.length;e++){let t=o[s],n=o[e],i=t.start+t.count,a=Ce(n.start,r.width,4),c=Ce(t.start,r.width,4);n.start<=i+1&&a===c&&Ce(n.start+n.count-1,r.width,4)===a?t.count=Math.max(t.count,n.start+n.count-t.start):(++s,o[s]=n)}o.length=s+1;let c=n.getParameter(e.UNPACK_ROW_LENGTH),l=n.getParameter(e.UNPACK_SKIP_PIXELS),u=n.getParameter(e.UNPACK_SKIP_ROWS);n.pixelStorei(e.UNPACK_ROW_LENGTH,r.width);for(let t=0,s=o.length;t<s;t++){let s=o[t],c=Math.floor(s.start/4),l=Math.ceil(s.count/4),u=c%r.width,d=Math.floor(c/r.width),f=l;n.pixelStorei(e.UNPACK_SKIP_PIXELS,u),n.pixelStorei(e.UNPACK_SKIP_ROWS,d),n.texSubImage2D(e.TEXTURE_2D,0,u,d,f,1,i,a,r.data)}t.clearUpdateRanges(),n.pixelStorei(e.UNPACK_ROW_LENGTH,c),n.pixelStorei(e.UNPACK_SKIP_PIXELS,l),n.pixelStorei(e.UNPACK_SKIP_ROWS,u)}}function Te(t,o,s){let c=e.TEXTURE_2D;(o.isDataArrayTexture||o.isCompressedArrayTexture)&&(c=e.TEXTURE_2D_ARRAY),o.isData3DTexture&&(c=e.TEXTURE_3D);let l=Se(t,o),u=o.source;n.bindTexture(c,t.__webglTexture,e.TEXTURE0+s);let f=r.get(u);if(u.version!==f.__version||l===!0){if(n.activeTexture(e.TEXTURE0+s),!(typeof ImageBitmap<`u`&&o.image instanceof ImageBitmap)){let t=q.getPrimaries(q.workingColorSpace),r=o.colorSpace===``?null:q.getPrimaries(o.colorSpace),i=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,i)}n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment);let t=v(o.image,!1,i.maxTextureSize);t=z(o,t);let r=a.convert(o.format,o.colorSpace),p=a.convert(o.type),m=S(o.internalFormat,r,p,o.normalized,o.colorSpace,o.isVideoTexture);xe(c,o);let h,g=o.mipmaps,_=o.isVideoTexture!==!0,x=f.__version===void 0||l===!0,T=u.dataReady,E=w(o,t);if(o.isDepthTexture)m=C(o.format===ye,o.type),x&&(_?n.texStorage2D(e.TEXTURE_2D,1,m,t.width,t.height):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,null));else if(o.isDataTexture){if(g.length>0){_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data);o.generateMipmaps=!1}else _?(x&&n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height),T&&we(o,t,r,p)):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,t.data)}else if(o.isCompressedTexture){if(o.isCompressedArrayTexture){_&&x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,g[0].width,g[0].height,t.depth);for(let i=0,a=g.length;i<a;i++)if(h=g[i],o.format!==1023){if(r!==null){if(_){if(T){if(o.layerUpdates.size>0){let t=Bo(h.width,h.height,o.format,o.type);for(let a of o.layerUpdates){let o=h.data.subarray(a*t/h.data.BYTES_PER_ELEMENT,(a+1)*t/h.data.BYTES_PER_ELEMENT);n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,a,h.width,h.height,1,r,o)}}else n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,h.data)}}else n.compressedTexImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,h.data,0,0)}else V(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`)}else _?T&&n.texSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,p,h.data):n.texImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,r,p,h.data);o.layerUpdates.size>0&&o.clearLayerUpdates()}else{_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],o.format===1023?_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data):r===null?V(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`):_?T&&n.compressedTexSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,h.data):n.compressedTexImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,h.data)}}else if(o.isDataArrayTexture){if(_){if(x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,t.width,t.height,t.depth),T){if(o.layerUpdates.size>0){let i=Bo(t.width,t.height,o.format,o.type);for(let a of o.layerUpdates){let o=t.data.subarray(a*i/t.data.BYTES_PER_ELEMENT,(a+1)*i/t.data.BYTES_PER_ELEMENT);n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,a,t.width,t.height,1,r,p,o)}o.clearLayerUpdates()}else n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)}}else n.texImage3D(e.TEXTURE_2D_ARRAY,0,m,t.width,t.height,t.depth,0,r,p,t.data)}else if(o.isData3DTexture)_?(x&&n.texStorage3D(e.TEXTURE_3D,E,m,t.width,t.height,t.depth),T&&n.texSubImage3D(e.TEXTURE_3D,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)):n.texImage3D(e.TEXTURE_3D,0,m,t.width,t.height,t.depth,0,r,p,t.data);else if(o.isFramebufferTexture){if(x){if(_)n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height);else{let i=t.width,a=t.height;for(let t=0;t<E;t++)n.texImage2D(e.TEXTURE_2D,t,m,i,a,0,r,p,null),i>>=1,a>>=1}}}else if(o.isHTMLTexture){if(`texElementImage2D`in e){let n=e.canvas;if(n.hasAttribute(`layoutsubtree`)||n.setAttribute(`layoutsubtree`,`true`),t.parentNode!==n){n.appendChild(t),d.add(o),n.onpaint=e=>{let t=e.changedElements;for(let e of d)t.includes(e.image)&&(e.needsUpdate=!0)},n.requestPaint();return}if(e.texElementImage2D.length===3)e.texElementImage2D(e.TEXTURE_2D,e.RGBA8,t);else{let n=e.RGBA,r=e.RGBA,i=e.UNSIGNED_BYTE;e.texElementImage2D(e.TEXTURE_2D,0,n,r,i,t)}e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.LINEAR),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_S,e.CLAMP_TO_EDGE),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_T,e.CLAMP_TO_EDGE)}}else if(g.length>0){if(_&&x){let t=B(g[0]);n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height)}for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,r,p,h):n.texImage2D(e.TEXTURE_2D,t,m,r,p,h);o.generateMipmaps=!1}else if(_){if(x){let r=B(t);n.texStorage2D(e.TEXTURE_2D,E,m,r.width,r.height)}T&&n.texSubImage2D(e.TEXTURE_2D,0,0,0,r,p,t)}else n.texImage2D(e.TEXTURE_2D,0,m,r,p,t);y(o)&&o.mipmapsAutoUpdate===!0&&b(c),f.__version=u.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function Ee(t,o,s){if(o.image.length!==6)return;let c=Se(t,o),l=o.source;n.bindTexture(e.TEXTURE_CUBE_MAP,t.__webglTexture,e.TEXTURE0+s);let u=r.get(l);if(l.version!==u.__version||c===!0){n.activeTexture(e.TEXTURE0+s);let t=q.getPrimaries(q.workingColorSpace),r=o.colorSpace===``?null:q.getPrimaries(o.colorSpace),d=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,d);let f=o.isCompressedTexture||o.image[0].isCompressedTexture,p=o.image[0]&&o.image[0].isDataTexture,m=[];for(let e=0;e<6;e++)!f&&!p?m[e]=v(o.image[e],!0,i.maxCubemapSize):m[e]=p?o.image[e].image:o.image[e],m[e]=z(o,m[e]);let h=m[0],g=a.convert(o.format,o.colorSpace),_=a.convert(o.type),x=S(o.internalFormat,g,_,o.normalized,o.colorSpace),T=o.isVideoTexture!==!0,E=u.__version===void 0||c===!0,D=l.dataReady,O=w(o,h);xe(e.TEXTURE_CUBE_MAP,o);let k;if(o.isDepthTexture){if(x=C(o.format===ye,o.type),E){if(T)n.texStorage2D(e.TEXTURE_CUBE_MAP,1,x,h.width,h.height);else for(let t=0;t<6;t++)n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,h.width,h.height,0,g,_,null)}}else if(f){T&&E&&n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,h.width,h.height);for(let t=0;t<6;t++){k=m[t].mipmaps;for(let r=0;r<k.length;r++){let i=k[r];o.format===1023?T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,g,_,i.data):g===null?V(`WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()`):T?D&&n.compressedTexSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,i.data):n.compressedTexImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,i.data)}}}else{if(k=o.mipmaps,T&&E){k.length>0&&O++;let t=B(m[0]);n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,t.width,t.height)}for(let t=0;t<6;t++)if(p){T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,m[t].width,m[t].height,g,_,m[t].data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,m[t].width,m[t].height,0,g,_,m[t].data);for(let r=0;r<k.length;r++){let i=k[r].image[t].image;T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,i.width,i.height,0,g,_,i.data)}}else{T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,g,_,m[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,g,_,m[t]);for(let r=0;r<k.length;r++){let i=k[r];T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,g,_,i.image[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,g,_,i.image[t])}}}y(o)&&o.mipmapsAutoUpdate===!0&&b(e.TEXTURE_CUBE_MAP),u.__version=l.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function De(t,i,o,c,l,u){let d=a.convert(o.format,o.colorSpace),f=a.convert(o.type),p=S(o.internalFormat,d,f,o.normalized,o.colorSpace),m=r.get(i),h=r.get(o);if(h.__renderTarget=i,!m.__hasExternalTextures){let t=Math.max(1,i.width>>u),r=Math.max(1,i.height>>u);l===e.TEXTURE_3D||l===e.TEXTURE_2D_ARRAY?n.texImage3D(l,u,p,t,r,i.depth,0,d,f,null):n.texImage2D(l,u,p,t,r,0,d,f,null)}n.bindFramebuffer(e.FRAMEBUFFER,t),R(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,c,l,h.__webglTexture,0,Fe(i)):(l===e.TEXTURE_2D||l>=e.TEXTURE_CUBE_MAP_POSITIVE_X&&l<=e.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&e.framebufferTexture2D(e.FRAMEBUFFER,c,l,h.__webglTexture,u),n.bindFramebuffer(e.FRAMEBUFFER,null)}function Oe(t,n,r){if(e.bindRenderbuffer(e.RENDERBUFFER,t),n.depthBuffer){let i=n.depthTexture,a=i&&i.isDepthTexture?i.type:null,o=C(n.stencilBuffer,a),c=n.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;R(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,Fe(n),o,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,Fe(n),o,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,o,n.width,n.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,c,e.RENDERBUFFER,t)}else{let t=n.textures;for(let i=0;i<t.length;i++){let o=t[i],c=a.convert(o.format,o.colorSpace),l=a.convert(o.type),u=S(o.internalFormat,c,l,o.normalized,o.colorSpace);R(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,Fe(n),u,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,Fe(n),u,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,u,n.width,n.height)}}e.bindRenderbuffer(e.RENDERBUFFER,null)}function ke(t,i,a){let o=i.isWebGLCubeRenderTarget===!0;if(n.bindFramebuffer(e.FRAMEBUFFER,t),!(i.depthTexture&&i.depthTexture.isDepthTexture))throw Error(`THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.`);let c=r.get(i.depthTexture);c.__renderTarget=i;let l=o?i.depthTexture.image[0]:i.depthTexture.image;c.__webglTexture&&l.width===i.width&&l.height===i.height||(l.width=i.width,l.height=i.height,i.depthTexture.needsUpdate=!0),o?ge(i.depthTexture,0):pe(i.depthTexture,0);let u=c.__webglTexture,d=Fe(i),f=o?e.TEXTURE_CUBE_MAP_POSITIVE_X+a:e.TEXTURE_2D,p=i.depthTexture.format===1027?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;if(i.depthTexture.format===1026)R(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else if(i.depthTexture.format===1027)R(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else throw Error(`THREE.WebGLTextures: Unknown depthTexture format.`)}function Ae(t){let i=r.get(t),a=t.isWebGLCubeRenderTarget===!0;if(i.__boundDepthTexture!==t.depthTexture){let e=t.depthTexture;if(i.__depthDisposeCallback&&i.__depthDisposeCallback(),e){let t=()=>{delete i.__boundDepthTexture,delete i.__depthDisposeCallback,e.removeEventListener(`dispose`,t)};e.addEventListener(`dispose`,t),i.__depthDisposeCallback=t}i.__boundDepthTexture=e}if(t.depthTexture&&!i.__autoAllocateDepthBuffer){if(a)for(let e=0;e<6;e++)ke(i.__webglFramebuffer[e],t,e);else t.texture.mipmaps.length>0?ke(i.__webglFramebuffer[0],t,0):ke(i.__webglFramebuffer,t,0)}else if(a){i.__webglDepthbuffer=[];for(let r=0;r<6;r++)if(n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[r]),i.__webglDepthbuffer[r]===void 0)i.__webglDepthbuffer[r]=e.createRenderbuffer(),Oe(i.__webglDepthbuffer[r],t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,a=i.__webglDepthbuffer[r];e.bindRenderbuffer(e.RENDERBUFFER,a),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,a)}}else if(t.texture.mipmaps.length>0?n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[0]):n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer),i.__webglDepthbuffer===void 0)i.__webglDepthbuffer=e.createRenderbuffer(),Oe(i.__webglDepthbuffer,t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,r=i.__webglDepthbuffer;e.bindRenderbuffer(e.RENDERBUFFER,r),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,r)}n.bindFramebuffer(e.FRAMEBUFFER,null)}function je(t,n,i){let a=r.get(t);n!==void 0&&De(a.__webglFramebuffer,t,t.texture,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,0),i!==void 0&&Ae(t)}function Me(t){let i=t.texture,s=r.get(t),c=r.get(i);t.addEventListener(`dispose`,O),T(t);let l=t.textures,u=t.isWebGLCubeRenderTarget===!0,d=l.length>1;if(d||(c.__webglTexture===void 0&&(c.__webglTexture=e.createTexture()),c.__version=i.version,o.memory.textures++),u){s.__webglFramebuffer=[];for(let t=0;t<6;t++)if(i.mipmaps.length>0){s.__webglFramebuffer[t]=[];for(let n=0;n<i.mipmaps.length;n++)s.__webglFramebuffer[t][n]=e.createFramebuffer()}else s.__webglFramebuffer[t]=e.createFramebuffer()}else{if(i.mipmaps.length>0){s.__webglFramebuffer=[];for(let t=0;t<i.mipmaps.length;t++)s.__webglFramebuffer[t]=e.createFramebuffer()}else s.__webglFramebuffer=e.createFramebuffer();if(d)for(let t=0,n=l.length;t<n;t++){let n=r.get(l[t]);n.__webglTexture===void 0&&(n.__webglTexture=e.createTexture(),o.memory.textures++)}if(t.samples>0&&R(t)===!1){s.__webglMultisampledFramebuffer=e.createFramebuffer(),s.__webglColorRenderbuffer=[],n.bindFramebuffer(e.FRAMEBUFFER,s.__webglMultisampledFramebuffer);for(let n=0;n<l.length;n++){let r=l[n];s.__webglColorRenderbuffer[n]=e.createRenderbuffer(),e.bindRenderbuffer(e.RENDERBUFFER,s.__webglColorRenderbuffer[n]);let i=a.convert(r.format,r.colorSpace),o=a.convert(r.type),c=S(r.internalFormat,i,o,r.normalized,r.colorSpace,t.isXRRenderTarget===!0),u=Fe(t);e.renderbufferStorageMultisample(e.RENDERBUFFER,u,c,t.width,t.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+n,e.RENDERBUFFER,s.__webglColorRenderbuffer[n])}e.bindRenderbuffer(e.RENDERBUFFER,null),t.depthBuffer&&(s.__webglDepthRenderbuffer=e.createRenderbuffer(),Oe(s.__webglDepthRenderbuffer,t,!0)),n.bindFramebuffer(e.FRAMEBUFFER,null)}}if(u){n.bindTexture(e.TEXTURE_CUBE_MAP,c.__webglTexture),xe(e.TEXTURE_CUBE_MAP,i);for(let n=0;n<6;n++)if(i.mipmaps.length>0)for(let r=0;r<i.mipmaps.length;r++)De(s.__webglFramebuffer[n][r],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,r);else De(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,0);y(i)?b(e.TEXTURE_CUBE_MAP):i.mipmaps.length>0&&e.texParameteri(e.TEXTURE_CUBE_MAP,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}else if(d){for(let i=0,a=l.length;i<a;i++){let a=l[i],o=r.get(a),c=e.TEXTURE_2D;(t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(c=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(c,o.__webglTexture),xe(c,a),De(s.__webglFramebuffer,t,a,e.COLOR_ATTACHMENT0+i,c,0),y(a)&&b(c)}n.unbindTexture()}else{let r=e.TEXTURE_2D;if((t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(r=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(r,c.__webglTexture),xe(r,i),i.mipmaps.length>0)for(let n=0;n<i.mipmaps.length;n++)De(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,r,n);else De(s.__webglFramebuffer,t,i,e.COLOR_ATTACHMENT0,r,0);y(i)?b(r):i.mipmaps.length>0&&e.texParameteri(r,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}t.depthBuffer&&Ae(t)}function L(e){let t=e.textures;for(let i=0,a=t.length;i<a;i++){let a=t[i];if(y(a)&&a.mipmapsAutoUpdate===!0){let t=x(e),i=r.get(a).__webglTexture;n.bindTexture(t,i),b(t),n.unbindTexture()}}}let Ne=[];function Pe(t){if(t.samples>0){if(R(t)===!1){let i=t.textures,a=t.width,o=t.height,s=e.COLOR_BUFFER_BIT,l=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,u=r.get(t),d=i.length>1;if(d)for(let t=0;t<i.length;t++)n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,null),n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,null,0);n.bindFramebuffer(e.READ_FRAMEBUFFER,u.__webglMultisampledFramebuffer),t.texture.mipmaps.length>0?n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer[0]):n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer);for(let n=0;n<i.length;n++){if(t.resolveDepthBuffer&&(t.depthBuffer&&(s|=e.DEPTH_BUFFER_BIT),t.stencilBuffer&&t.resolveStencilBuffer&&(s|=e.STENCIL_BUFFER_BIT)),d){e.framebufferRenderbuffer(e.READ_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.RENDERBUFFER,u.__webglColorRenderbuffer[n]);let t=r.get(i[n]).__webglTexture;e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,t,0)}e.blitFramebuffer(0,0,a,o,0,0,a,o,s,e.NEAREST),c===!0&&(Ne.length=0,Ne.push(e.COLOR_ATTACHMENT0+n),t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&Ne.push(l),e.invalidateFramebuffer(e.READ_FRAMEBUFFER,Ne))}if(n.bindFramebuffer(e.READ_FRAMEBUFFER,null),n.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),d)for(let t=0;t<i.length;t++){n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,u.__webglColorRenderbuffer[t]);let a=r.get(i[t]).__webglTexture;n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,a,0)}n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglMultisampledFramebuffer)}else if(t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&c){let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;e.invalidateFramebuffer(e.DRAW_FRAMEBUFFER,[n])}}}function Fe(e){return Math.min(i.maxSamples,e.samples)}function R(e){let n=r.get(e);return e.samples>0&&t.has(`WEBGL_multisampled_render_to_texture`)===!0&&n.__useRenderToTexture!==!1}function Ie(e){let t=o.render.frame;u.get(e)!==t&&(u.set(e,t),e.update())}function z(e,t){let n=e.colorSpace,r=e.format,i=e.type;return e.isCompressedTexture===!0||e.isVideoTexture===!0||n!==`srgb-linear`&&n!==``&&(q.getTransfer(n)===`srgb`?(r!==1023||i!==1009)&&V(`WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType.`):H(`WebGLTextures: Unsupported texture color space:`,n)),t}function B(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement?(l.width=e.naturalWidth||e.width,l.height=e.naturalHeight||e.height):typeof VideoFrame<`u`&&e instanceof VideoFrame?(l.width=e.displayWidth,l.height=e.displayHeight):(l.width=e.width,l.height=e.height),l}this.allocateTextureUnit=de,this.resetTextureUnits=I,this.getTextureUnits=le,this.setTextureUnits=ue,this.setTexture2D=pe,this.setTexture2DArray=me,this.setTexture3D=he,this.setTextureCube=ge,this.rebindTextures=je,this.setupRenderTarget=Me,this.updateRenderTargetMipmap=L,this.updateMultisampleRenderTarget=Pe,this.setupDepthRenderbuffer=Ae,this.setupFrameBufferTexture=De,this.useMultisampledRTT=R,this.dispose=ae}function zl(e,t){function n(n,r=``){let i,a=q.getTransfer(r);if(n===1009)return e.UNSIGNED_BYTE;if(n===1017)return e.UNSIGNED_SHORT_4_4_4_4;if(n===1018)return e.UNSIGNED_SHORT_5_5_5_1;if(n===35902)return e.UNSIGNED_INT_5_9_9_9_REV;if(n===35899)return e.UNSIGNED_INT_10F_11F_11F_REV;if(n===1010)return e.BYTE;if(n===1011)return e.SHORT;if(n===1012)return e.UNSIGNED_SHORT;if(n===1013)return e.INT;if(n===1014)return e.UNSIGNED_INT;if(n===1015)return e.FLOAT;if(n===1016)return e.HALF_FLOAT;if(n===1021)return e.ALPHA;if(n===1022)return e.RGB;if(n===1023)return e.RGBA;if(n===1026)return e.DEPTH_COMPONENT;if(n===1027)return e.DEPTH_STENCIL;if(n===1028)return e.RED;if(n===1029)return e.RED_INTEGER;if(n===1030)return e.RG;if(n===1031)return e.RG_INTEGER;if(n===1033)return e.RGBA_INTEGER;if(n===33776||n===33777||n===33778||n===33779){if(a===`srgb`){if(i=t.get(`WEBGL_compressed_texture_s3tc_srgb`),i!==null){if(n===33776)return i.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null}else if(i=t.get(`WEBGL_compressed_texture_s3tc`),i!==null){if(n===33776)return i.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null}if(n===35840||n===35841||n===35842||n===35843){if(i=t.get(`WEBGL_compressed_texture_pvrtc`),i!==null){if(n===35840)return i.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===35841)return i.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===35842)return i.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===35843)return i.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null}if(n===36196||n===37492||n===37496||n===37488||n===37489||n===37490||n===37491){if(i=t.get(`WEBGL_compressed_texture_etc`),i!==null){if(n===36196||n===37492)return a===`srgb`?i.COMPRESSED_SRGB8_ETC2:i.COMPRESSED_RGB8_ETC2;if(n===37496)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:i.COMPRESSED_RGBA8_ETC2_EAC;if(n===37488)return i.COMPRESSED_R11_EAC;if(n===37489)return i.COMPRESSED_SIGNED_R11_EAC;if(n===37490)return i.COMPRESSED_RG11_EAC;if(n===37491)return i.COMPRESSED_SIGNED_RG11_EAC}else return null}if(n===37808||n===37809||n===37810||n===37811||n===37812||n===37813||n===37814||n===37815||n===37816||n===37817||n===37818||n===37819||n===37820||n===37821){if(i=t.get(`WEBGL_compressed_texture_astc`),i!==null){if(n===37808)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:i.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===37809)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:i.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===37810)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:i.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===37811)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:i.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===37812)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:i.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===37813)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:i.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===37814)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:i.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===37815)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:i.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===37816)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:i.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===37817)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:i.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===37818)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:i.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===37819)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:i.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===37820)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:i.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===37821)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:i.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null}if(n===36492||n===36494||n===36495){if(i=t.get(`EXT_texture_compression_bptc`),i!==null){if(n===36492)return a===`srgb`?i.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:i.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===36494)return i.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===36495)return i.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null}if(n===36283||n===36284||n===36285||n===36286){if(i=t.get(`EXT_texture_compression_rgtc`),i!==null){if(n===36283)return i.COMPRESSED_RED_RGTC1_EXT;if(n===36284)return i.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===36285)return i.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===36286)return i.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null}return n===1020?e.UNSIGNED_INT_24_8:e[n]===void 0?null:e[n]}return{convert:n}}var Bl=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Vl=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Hl=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new ga(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Pa({vertexShader:Bl,fragmentShader:Vl,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Oi(new Ca(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Ul=class extends kt{constructor(e,t){super();let n=this,r=null,i=1,a=null,o=`local-floor`,s=1,c=null,l=null,u=null,d=null,f=null,p=null,m=typeof XRWebGLBinding<`u`,h=new Hl,g={},_=t.getContextAttributes(),v=null,y=null,b=[],x=[],S=new W,C=null,w=null,T=new fo;T.viewport=new J;let E=new fo;E.viewport=new J;let D=[T,E],O=new vo,k=null,A=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(e){let t=b[e];return t===void 0&&(t=new er,b[e]=t),t.getTargetRaySpace()},this.getControllerGrip=function(e){let t=b[e];return t===void 0&&(t=new er,b[e]=t),t.getGripSpace()},this.getHand=function(e){let t=b[e];return t===void 0&&(t=new er,b[e]=t),t.getHandSpace()};function j(e){let t=x.indexOf(e.inputSource);if(t===-1)return;let n=b[t];n!==void 0&&(n.update(e.inputSource,e.frame,c||a),n.dispatchEvent({type:e.type,data:e.inputSource}))}function M(){r.removeEventListener(`select`,j),r.removeEventListener(`selectstart`,j),r.removeEventListener(`selectend`,j),r.removeEventListener(`squeeze`,j),r.removeEventListener(`squeezestart`,j),r.removeEventListener(`squeezeend`,j),r.removeEventListener(`end`,M),r.removeEventListener(`inputsourceschange`,N);for(let e=0;e<b.length;e++){let t=x[e];t!==null&&(x[e]=null,b[e].disconnect(t))}k=null,A=null,h.reset();for(let e in g)delete g[e];if(e.setRenderTarget(v),f=null,d=null,u=null,r=null,y=null,re.stop(),n.isPresenting=!1,e.setPixelRatio(C),e.setSize(S.width,S.height,!1),w!==null){let e=w.camera;e.fov=w.fov,e.zoom=w.zoom,e.updateProjectionMatrix(),w=null}n.dispatchEvent({type:`sessionend`})}this.setFramebufferScaleFactor=function(e){i=e,n.isPresenting===!0&&V(`WebXRManager: Cannot change framebuffer scale while presenting.`)},this.setReferenceSpaceType=function(e){o=e,n.isPresenting===!0&&V(`WebXRManager: Cannot change reference space type while presenting.`)},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(e){c=e},this.getBaseLayer=function(){return d===null?f:d},this.getBinding=function(){return u===null&&m&&(u=new XRWebGLBinding(r,t)),u},this.getFrame=function(){return p},this.getSession=function(){return r},this.setSession=async function(l){if(r=l,r!==null){if(v=e.getRenderTarget(),r.addEventListener(`select`,j),r.addEventListener(`selectstart`,j),r.addEventListener(`selectend`,j),r.addEventListener(`squeeze`,j),r.addEventListener(`squeezestart`,j),r.addEventListener(`squeezeend`,j),r.addEventListener(`end`,M),r.addEventListener(`inputsourceschange`,N),_.xrCompatible!==!0&&await t.makeXRCompatible(),C=e.getPixelRatio(),e.getSize(S),m&&`createProjectionLayer`in XRWebGLBinding.prototype){let n=null,a=null,o=null;_.depth&&(o=_.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,n=_.stencil?ye:ve,a=_.stencil?fe:F);let s={colorFormat:t.RGBA8,depthFormat:o,scaleFactor:i};u=this.getBinding(),d=u.createProjectionLayer(s),r.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),y=new Sn(d.textureWidth,d.textureHeight,{format:_e,type:ie,depthTexture:new ma(d.textureWidth,d.textureHeight,a,void 0,void 0,void 0,void 0,void 0,void 0,n),stencilBuffer:_.stencil,colorSpace:e.outputColorSpace,samples:_.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let n={antialias:_.antialias,alpha:!0,depth:_.depth,stencil:_.stencil,framebufferScaleFactor:i};f=new XRWebGLLayer(r,t,n),r.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),y=new Sn(f.framebufferWidth,f.framebufferHeight,{format:_e,type:ie,colorSpace:e.outputColorSpace,stencilBuffer:_.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}y.isXRRenderTarget=!0,this.setFoveation(s),c=null,a=await r.requestReferenceSpace(o),re.setContext(r),re.start(),n.isPresenting=!0,n.dispatchEvent({type:`sessionstart`})}},this.getEnvironmentBlendMode=function(){if(r!==null)return r.environmentBlendMode},this.getDepthTexture=function(){return h.getDepthTexture()};function N(e){for(let t=0;t<e.removed.length;t++){let n=e.removed[t],r=x.indexOf(n);r>=0&&(x[r]=null,b[r].disconnect(n))}for(let t=0;t<e.added.length;t++){let n=e.added[t],r=x.indexOf(n);if(r===-1){for(let e=0;e<b.length;e++)if(e>=x.length){x.push(n),r=e;break}else if(x[e]===null){x[e]=n,r=e;break}if(r===-1)break}let i=b[r];i&&i.connect(n)}}function ee(e,t){t===null?e.matrixWorld.copy(e.matrix):e.matrixWorld.multiplyMatrices(t.matrixWorld,e.matrix),e.matrixWorldInverse.copy(e.matrixWorld).invert()}this.updateCamera=function(e){if(r===null)return;let t=e.near,n=e.far;h.texture!==null&&(h.depthNear>0&&(t=h.depthNear),h.depthFar>0&&(n=h.depthFar)),O.near=E.near=T.near=t,O.far=E.far=T.far=n,(k!==O.near||A!==O.far)&&(r.updateRenderState({depthNear:O.near,depthFar:O.far}),k=O.near,A=O.far),O.layers.mask=e.layers.mask|6,T.layers.mask=O.layers.mask&-5,E.layers.mask=O.layers.mask&-3;let i=e.parent,a=O.cameras;ee(O,i);for(let e=0;e<a.length;e++)ee(a[e],i);O.projectionMatrix.copy(T.projectionMatrix),O.projectionMatrixInverse.copy(T.projectionMatrixInverse),w===null&&e.isPerspectiveCamera&&(w={camera:e,fov:e.fov,zoom:e.zoom}),te(e,O,i)};function te(e,t,n){n===null?e.matrix.copy(t.matrixWorld):(e.matrix.copy(n.matrixWorld),e.matrix.invert(),e.matrix.multiply(t.matrixWorld)),e.matrix.decompose(e.position,e.quaternion,e.scale),e.updateMatrixWorld(!0),e.projectionMatrix.copy(t.projectionMatrix),e.projectionMatrixInverse.copy(t.projectionMatrixInverse),e.isPerspectiveCamera&&(e.fov=Nt*2*Math.atan(1/e.projectionMatrix.elements[5]),e.zoom=1)}this.getCamera=function(){return O},this.getFoveation=function(){if(d!==null||f!==null)return s},this.setFoveation=function(e){s=e,d!==null&&(d.fixedFoveation=e),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=e)},this.hasDepthSensing=function(){return h.texture!==null},this.getDepthSensingMesh=function(){return h.getMesh(O)},this.getCameraTexture=function(e){return g[e]};let P=null;function ne(t,i){if(l=i.getViewerPose(c||a),p=i,l!==null){let t=l.views;f!==null&&(e.setRenderTargetFramebuffer(y,f.framebuffer),e.setRenderTarget(y));let i=!1;t.length!==O.cameras.length&&(O.cameras.length=0,i=!0);for(let n=0;n<t.length;n++){let r=t[n],a=null;if(f!==null)a=f.getViewport(r);else{let t=u.getViewSubImage(d,r);a=t.viewport,n===0&&(e.setRenderTargetTextures(y,t.colorTexture,t.depthStencilTexture),e.setRenderTarget(y))}let o=D[n];o===void 0&&(o=new fo,o.layers.enable(n),o.viewport=new J,D[n]=o),o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.projectionMatrix.fromArray(r.projectionMatrix),o.projectionMatrixInverse.copy(o.projectionMatrix).invert(),o.viewport.set(a.x,a.y,a.width,a.height),n===0&&(O.matrix.copy(o.matrix),O.matrix.decompose(O.position,O.quaternion,O.scale)),i===!0&&O.cameras.push(o)}let a=r.enabledFeatures;if(a&&a.includes(`depth-sensing`)&&r.depthUsage==`gpu-optimized`&&m){u=n.getBinding();let e=u.getDepthInformation(t[0]);e&&e.isValid&&e.texture&&h.init(e,r.renderState)}if(a&&a.includes(`camera-access`)&&m){e.state.unbindTexture(),u=n.getBinding();for(let e=0;e<t.length;e++){let n=t[e].camera;if(n){let e=g[n];e||(e=new ga,g[n]=e);let t=u.getCameraImage(n);e.sourceTexture=t}}}}for(let e=0;e<b.length;e++){let t=x[e],n=b[e];t!==null&&n!==void 0&&n.update(t,i,c||a)}P&&P(t,i),i.detectedPlanes&&n.dispatchEvent({type:`planesdetected`,data:i}),p=null}let re=new Ho;re.setAnimationLoop(ne),this.setAnimationLoop=function(e){P=e},this.dispose=function(){}}},Wl=new Y,Gl=new K;Gl.set(-1,0,0,0,1,0,0,0,1);function Kl(e,t){function n(e,t){e.matrixAutoUpdate===!0&&e.updateMatrix(),t.value.copy(e.matrix)}function r(t,n){n.color.getRGB(t.fogColor.value,Aa(e)),n.isFog?(t.fogNear.value=n.near,t.fogFar.value=n.far):n.isFogExp2&&(t.fogDensity.value=n.density)}function i(e,t,n,r,i){t.isNodeMaterial?t.uniformsNeedUpdate=!1:t.isMeshBasicMaterial?a(e,t):t.isMeshLambertMaterial?(a(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshToonMaterial?(a(e,t),d(e,t)):t.isMeshPhongMaterial?(a(e,t),u(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshStandardMaterial?(a(e,t),f(e,t),t.isMeshPhysicalMaterial&&p(e,t,i)):t.isMeshMatcapMaterial?(a(e,t),m(e,t)):t.isMeshDepthMaterial?a(e,t):t.isMeshDistanceMaterial?(a(e,t),h(e,t)):t.isMeshNormalMaterial?a(e,t):t.isLineBasicMaterial?(o(e,t),t.isLineDashedMaterial&&s(e,t)):t.isPointsMaterial?c(e,t,n,r):t.isSpriteMaterial?l(e,t):t.isShadowMaterial?(e.color.value.copy(t.color),e.opacity.value=t.opacity):t.isShaderMaterial&&(t.uniformsNeedUpdate=!1)}function a(e,r){e.opacity.value=r.opacity,r.color&&e.diffuse.value.copy(r.color),r.emissive&&e.emissive.value.copy(r.emissive).multiplyScalar(r.emissiveIntensity),r.map&&(e.map.value=r.map,n(r.map,e.mapTransform)),r.alphaMap&&(e.alphaMap.value=r.alphaMap,n(r.alphaMap,e.alphaMapTransform)),r.bumpMap&&(e.bumpMap.value=r.bumpMap,n(r.bumpMap,e.bumpMapTransform),e.bumpScale.value=r.bumpScale,r.side===1&&(e.bumpScale.value*=-1)),r.normalMap&&(e.normalMap.value=r.normalMap,n(r.normalMap,e.normalMapTransform),e.normalScale.value.copy(r.normalScale),r.side===1&&e.normalScale.value.negate()),r.displacementMap&&(e.displacementMap.value=r.displacementMap,n(r.displacementMap,e.displacementMapTransform),e.displacementScale.value=r.displacementScale,e.displacementBias.value=r.displacementBias),r.emissiveMap&&(e.emissiveMap.value=r.emissiveMap,n(r.emissiveMap,e.emissiveMapTransform)),r.specularMap&&(e.specularMap.value=r.specularMap,n(r.specularMap,e.specularMapTransform)),r.alphaTest>0&&(e.alphaTest.value=r.alphaTest);let i=t.get(r),a=i.envMap,o=i.envMapRotation;a&&(e.envMap.value=a,e.envMapRotation.value.setFromMatrix4(Wl.makeRotationFromEuler(o)).transpose(),a.isCubeTexture&&a.isRenderTargetTexture===!1&&e.envMapRotation.value.premultiply(Gl),e.reflectivity.value=r.reflectivity,e.ior.value=r.ior,e.refractionRatio.value=r.refractionRatio),r.lightMap&&(e.lightMap.value=r.lightMap,e.lightMapIntensity.value=r.lightMapIntensity,n(r.lightMap,e.lightMapTransform)),r.aoMap&&(e.aoMap.value=r.aoMap,e.aoMapIntensity.value=r.aoMapIntensity,n(r.aoMap,e.aoMapTransform))}function o(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform))}function s(e,t){e.dashSize.value=t.dashSize,e.totalSize.value=t.dashSize+t.gapSize,e.scale.value=t.scale}function c(e,t,r,i){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.size.value=t.size*r,e.scale.value=i*.5,t.map&&(e.map.value=t.map,n(t.map,e.uvTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function l(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.rotation.value=t.rotation,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function u(e,t){e.specular.value.copy(t.specular),e.shininess.value=Math.max(t.shininess,1e-4)}function d(e,t){t.gradientMap&&(e.gradientMap.value=t.gradientMap)}function f(e,t){e.metalness.value=t.metalness,t.metalnessMap&&(e.metalnessMap.value=t.metalnessMap,n(t.metalnessMap,e.metalnessMapTransform)),e.roughness.value=t.roughness,t.roughnessMap&&(e.roughnessMap.value=t.roughnessMap,n(t.roughnessMap,e.roughnessMapTransform)),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)}function p(e,t,r){e.ior.value=t.ior,t.diffuseRoughness>0&&(e.diffuseRoughness.value=t.diffuseRoughness,t.diffuseRoughnessMap&&(e.diffuseRoughnessMap.value=t.diffuseRoughnessMap,n(t.diffuseRoughnessMap,e.diffuseRoughnessMapTransform))),t.sheen>0&&(e.sheenColor.value.copy(t.sheenColor).multiplyScalar(t.sheen),e.sheenRoughness.value=t.sheenRoughness,t.sheenColorMap&&(e.sheenColorMap.value=t.sheenColorMap,n(t.sheenColorMap,e.sheenColorMapTransform)),t.sheenRoughnessMap&&(e.sheenRoughnessMap.value=t.sheenRoughnessMap,n(t.sheenRoughnessMap,e.sheenRoughnessMapTransform))),t.clearcoat>0&&(e.clearcoat.value=t.clearcoat,e.clearcoatRoughness.value=t.clearcoatRoughness,t.clearcoatMap&&(e.clearcoatMap.value=t.clearcoatMap,n(t.clearcoatMap,e.clearcoatMapTransform)),t.clearcoatRoughnessMap&&(e.clearcoatRoughnessMap.value=t.clearcoatRoughnessMap,n(t.clearcoatRoughnessMap,e.clearcoatRoughnessMapTransform)),t.clearcoatNormalMap&&(e.clearcoatNormalMap.value=t.clearcoatNormalMap,n(t.clearcoatNormalMap,e.clearcoatNormalMapTransform),e.clearcoatNormalScale.value.copy(t.clearcoatNormalScale),t.side===1&&e.clearcoatNormalScale.value.negate())),t.dispersion>0&&(e.dispersion.value=t.dispersion),t.retroreflectivity>0&&(e.retroreflectivity.value=t.retroreflectivity),t.iridescence>0&&(e.iridescence.value=t.iridescence,e.iridescenceIOR.value=t.iridescenceIOR,e.iridescenceThicknessMinimum.value=t.iridescenceThicknessMinimum,e.iridescenceThicknessMaximum.value=t.iridescenceThicknessMaximum,t.iridescenceMap&&(e.iridescenceMap.value=t.iridescenceMap,n(t.iridescenceMap,e.iridescenceMapTransform)),t.iridescenceThicknessMap&&(e.iridescenceThicknessMap.value=t.iridescenceThicknessMap,n(t.iridescenceThicknessMap,e.iridescenceThicknessMapTransform))),t.transmission>0&&(e.transmission.value=t.transmission,e.transmissionSamplerMap.value=r.texture,e.transmissionSamplerSize.value.set(r.width,r.height),t.transmissionMap&&(e.transmissionMap.value=t.transmissionMap,n(t.transmissionMap,e.transmissionMapTransform)),e.thickness.value=t.thickness,t.thicknessMap&&(e.thicknessMap.value=t.thicknessMap,n(t.thicknessMap,e.thicknessMapTransform)),e.attenuationDistance.value=t.attenuationDistance,e.attenuationColor.value.copy(t.attenuationColor)),t.anisotropy>0&&(e.anisotropyVector.value.set(t.anisotropy*Math.cos(t.anisotropyRotation),t.anisotropy*Math.sin(t.anisotropyRotation)),t.anisotropyMap&&(e.anisotropyMap.value=t.anisotropyMap,n(t.anisotropyMap,e.anisotropyMapTransform))),e.specularIntensity.value=t.specularIntensity,e.specularColor.value.copy(t.specularColor),t.specularColorMap&&(e.specularColorMap.value=t.specularColorMap,n(t.specularColorMap,e.specularColorMapTransform)),t.specularIntensityMap&&(e.specularIntensityMap.value=t.specularIntensityMap,n(t.specularIntensityMap,e.specularIntensityMapTransform))}function m(e,t){t.matcap&&(e.matcap.value=t.matcap)}function h(e,n){let r=t.get(n).light;e.referencePosition.value.setFromMatrixPosition(r.matrixWorld),e.nearDistance.value=r.shadow.camera.near,e.farDistance.value=r.shadow.camera.far}return{refreshFogUniforms:r,refreshMaterialUniforms:i}}function ql(e,t,n,r){let i={},a={};function o(e,t){let n=t.program;r.uniformBlockBinding(e,n,i[e.id])}function s(e,n){let o=i[e.id];o===void 0&&(m(e),o=c(e),i[e.id]=o,e.addEventListener(`dispose`,g));let s=n.program;r.updateUBOMapping(e,s);let u=t.render.frame;a[e.id]!==u&&(l(e),a[e.id]=u)}function c(t){let n=e.createBuffer(),r=t.__size,i=t.usage;return e.bindBuffer(e.UNIFORM_BUFFER,n),e.bufferData(e.UNIFORM_BUFFER,r,i),e.bindBuffer(e.UNIFORM_BUFFER,null),n}function l(t){let n=i[t.id],r=t.uniforms,a=t.__cache;e.bindBuffer(e.UNIFORM_BUFFER,n);for(let e=0,t=r.length;e<t;e++){let t=r[e];if(Array.isArray(t))for(let n=0,r=t.length;n<r;n++)u(t[n],e,n,a);else u(t,e,0,a)}e.bindBuffer(e.UNIFORM_BUFFER,null)}function u(t,n,r,i){if(f(t,n,r,i)===!0){let n=t.__offset,r=t.value;if(Array.isArray(r)){let e=0;for(let n=0;n<r.length;n++){let i=r[n],a=h(i,!0);d(i,t.__data,e),e+=a.storage/Float32Array.BYTES_PER_ELEMENT}}else d(r,t.__data,0);e.bufferSubData(e.UNIFORM_BUFFER,n,t.__data)}}function d(e,t,n){typeof e==`number`||typeof e==`boolean`?t[n]=e:e.isMatrix3?(t[n]=e.elements[0],t[n+1]=e.elements[1],t[n+2]=e.elements[2],t[n+3]=0,t[n+4]=e.elements[3],t[n+5]=e.elements[4],t[n+6]=e.elements[5],t[n+7]=0,t[n+8]=e.elements[6],t[n+9]=e.elements[7],t[n+10]=e.elements[8],t[n+11]=0):ArrayBuffer.isView(e)?t.set(e.subarray(0,t.length-n),n):e.toArray(t,n)}function f(e,t,n,r){let i=e.value,a=t+`_`+n;if(Array.isArray(i)){r[a]===void 0&&(r[a]=[]);let e=r[a],t=!1;for(let n=0;n<i.length;n++)p(i[n],e,n)===!0&&(t=!0);return t}return p(i,r,a)}function p(e,t,n){if(t[n]===void 0)return t[n]=typeof e==`number`||typeof e==`boolean`?e:ArrayBuffer.isView(e)?e.slice():e.clone(),!0;{let r=t[n];if(typeof e==`number`||typeof e==`boolean`){if(r!==e)return t[n]=e,!0}else if(ArrayBuffer.isView(e))return!0;else if(r.equals(e)===!1)return r.copy(e),!0}return!1}function m(e){let t=e.uniforms,n=0;for(let e=0,r=t.length;e<r;e++){let r=Array.isArray(t[e])?t[e]:[t[e]];for(let i=0,a=r.length;i<a;i++){let a=r[i],o=Array.isArray(a.value)?a.value:[a.value],s=Array.isArray(t[e])||Array.isArray(a.value),c=n;for(let e=0,t=o.length;e<t;e++){let t=o[e],r=h(t,s),i=n%16,a=i%r.boundary,l=i+a;n+=a,l!==0&&16-l<r.storage&&(n+=16-l),e===0&&(c=n),n+=r.storage}a.__data=new(a.type===`int`?Int32Array:a.type===`uint`?Uint32Array:Float32Array)((n-c)/Float32Array.BYTES_PER_ELEMENT),a.__offset=c}}let r=n%16;return r>0&&(n+=16-r),e.__size=n,e.__cache={},this}function h(e,t){let n={boundary:0,storage:0};return typeof e==`number`||typeof e==`boolean`?(n.boundary=4,n.storage=4):e.isVector2?(n.boundary=8,n.storage=8):e.isVector3||e.isColor?(n.boundary=16,n.storage=12):e.isVector4?(n.boundary=16,n.storage=16):e.isMatrix3?(n.boundary=16,n.storage=48):e.isMatrix4?(n.boundary=16,n.storage=64):e.isTexture?V(`WebGLRenderer: Texture samplers can not be part of an uniforms group.`):ArrayBuffer.isView(e)?(n.boundary=16,n.storage=e.byteLength):V(`WebGLRenderer: Unsupported uniform value type.`,e),t===!0&&(n.boundary=16,n.storage=Math.ceil(n.storage/16)*16),n}function g(t){let n=t.target;n.removeEventListener(`dispose`,g),e.deleteBuffer(i[n.id]),delete i[n.id],delete a[n.id]}function _(){for(let t in i)e.deleteBuffer(i[t]);i={},a={}}return{bind:o,update:s,dispose:_}}var Jl=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Yl=null;function Xl(){return Yl===null&&(Yl=new ji(Jl,16,16,Se,le),Yl.name=`DFG_LUT`,Yl.minFilter=P,Yl.magFilter=P,Yl.wrapS=j,Yl.wrapT=j,Yl.generateMipmaps=!1,Yl.needsUpdate=!0),Yl}var Zl=class{constructor(e={}){let{canvas:t=St(),context:n=null,depth:r=!0,stencil:i=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:s=!0,preserveDrawingBuffer:c=!1,powerPreference:l=`default`,failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=ie}=e;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<`u`&&n instanceof WebGLRenderingContext)throw Error(`THREE.WebGLRenderer: WebGL 1 is not supported since r163.`);p=n.getContextAttributes().alpha}else p=a;let m=f,h=new Set([we,Ce,xe]),g=new Set([ie,F,se,fe,ue,de]),_=new Uint32Array(4),v=new Int32Array(4),y={textures:[],min:[],max:[],resolution:[]},b=null,x=null,S=[],C=[],w=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=0,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let T=this,E=!1,D=null,O=null,k=null,A=null;this._outputColorSpace=dt;let j=0,M=0,N=null,ee=-1,te=null,P=new J,ne=new J,ae=null,oe=new X(0),ce=0,I=t.width,pe=t.height,me=1,he=null,ge=null,_e=new J(0,0,I,pe),ve=new J(0,0,I,pe),ye=!1,be=new Wi,Se=new Ki,Te=!1,Ee=!1,De=new Y,Oe=new G,ke=new J,Ae={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},je=!1;function Me(){return N===null?me:1}let L=n;function Ne(e,n){return t.getContext(e,n)}let Pe,Fe,R,Ie,z,B,Le,Re,ze,Be,Ve,He,Ue,We,Ge,Ke,qe,Je,Ye,Xe,Ze,Qe,$e;try{let e={alpha:!0,depth:r,stencil:i,antialias:o,premultipliedAlpha:s,preserveDrawingBuffer:c,powerPreference:l,failIfMajorPerformanceCaveat:u};if(`setAttribute`in t&&t.setAttribute(`data-engine`,`three.js r187`),t.addEventListener(`webglcontextlost`,nt,!1),t.addEventListener(`webglcontextrestored`,rt,!1),t.addEventListener(`webglcontextcreationerror`,it,!1),L===null){let t=`webgl2`;if(L=Ne(t,e),L===null)throw Ne(t)?Error(`THREE.WebGLRenderer: Error creating WebGL context with your selected attributes.`):Error(`THREE.WebGLRenderer: Error creating WebGL context.`)}et()}catch(e){throw t.removeEventListener(`webglcontextlost`,nt,!1),t.removeEventListener(`webglcontextrestored`,rt,!1),t.removeEventListener(`webglcontextcreationerror`,it,!1),H(`WebGLRenderer: `+e.message),e}function et(){Pe=new _s(L),Pe.init(),Ze=new zl(L,Pe),Fe=new Zo(L,Pe,e,Ze),R=new Ll(L,Pe),Fe.reversedDepthBuffer&&d&&R.buffers.depth.setReversed(!0),O=L.createFramebuffer(),k=L.createFramebuffer(),A=L.createFramebuffer(),Ie=new bs(L),z=new _l,B=new Rl(L,Pe,R,z,Fe,Ze,Ie),Le=new gs(T),Re=new Uo(L),Qe=new Yo(L,Re),ze=new vs(L,Re,Ie,Qe),Be=new Ss(L,ze,Re,Qe,Ie),Je=new xs(L,Fe,B),Ge=new Qo(z),Ve=new gl(T,Le,Pe,Fe,Qe,Ge),He=new Kl(T,z),Ue=new xl,We=new Ol(Pe),qe=new Jo(T,Le,R,Be,p,s),Ke=new Il(T,Be,Fe),$e=new ql(L,Ie,Fe,R),Ye=new Xo(L,Pe,Ie),Xe=new ys(L,Pe,Ie),Ie.programs=Ve.programs,T.capabilities=Fe,T.extensions=Pe,T.properties=z,T.renderLists=Ue,T.shadowMap=Ke,T.state=R,T.info=Ie}m!==1009&&(w=new ws(m,t.width,t.height,o,r,i));let tt=new Ul(T,L);this.xr=tt,this.getContext=function(){return L},this.getContextAttributes=function(){return L.getContextAttributes()},this.forceContextLoss=function(){let e=Pe.get(`WEBGL_lose_context`);e&&e.loseContext()},this.forceContextRestore=function(){let e=Pe.get(`WEBGL_lose_context`);e&&e.restoreContext()},this.getPixelRatio=function(){return me},this.setPixelRatio=function(e){e!==void 0&&(me=e,this.setSize(I,pe,!1))},this.getSize=function(e){return e.set(I,pe)},this.setSize=function(e,n,r=!0){tt.isPresenting?V(`WebGLRenderer: Can't change size while VR device is presenting.`):(I=e,pe=n,t.width=Math.floor(e*me),t.height=Math.floor(n*me),r===!0&&(t.style.width=e+`px`,t.style.height=n+`px`),w!==null&&w.setSize(t.width,t.height),this.setViewport(0,0,e,n))},this.getDrawingBufferSize=function(e){return e.set(I*me,pe*me).floor()},this.setDrawingBufferSize=function(e,n,r){I=e,pe=n,me=r,t.width=Math.floor(e*r),t.height=Math.floor(n*r),this.setViewport(0,0,e,n)},this.setEffects=function(e){if(m===1009)H(`WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.`);else{if(e){for(let t=0;t<e.length;t++)if(e[t].isOutputPass===!0){V(`WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.`);break}}w.setEffects(e||[])}},this.getCurrentViewport=function(e){return e.copy(P)},this.getViewport=function(e){return e.copy(_e)},this.setViewport=function(e,t,n,r){e.isVector4?_e.set(e.x,e.y,e.z,e.w):_e.set(e,t,n,r),R.viewport(P.copy(_e).multiplyScalar(Me()).round())},this.getScissor=function(e){return e.copy(ve)},this.setScissor=function(e,t,n,r){e.isVector4?ve.set(e.x,e.y,e.z,e.w):ve.set(e,t,n,r),R.scissor(ne.copy(ve).multiplyScalar(Me()).round())},this.getScissorTest=function(){return ye},this.setScissorTest=function(e){R.setScissorTest(ye=e)},this.setOpaqueSort=function(e){he=e},this.setTransparentSort=function(e){ge=e},this.getClearColor=function(e){return e.copy(qe.getClearColor())},this.setClearColor=function(){qe.setClearColor(...arguments)},this.getClearAlpha=function(){return qe.getClearAlpha()},this.setClearAlpha=function(){qe.setClearAlpha(...arguments)},this.clear=function(e=!0,t=!0,n=!0){let r=0;if(e){let e=!1;if(N!==null){let t=N.texture.format;e=h.has(t)}if(e){let e=N.texture.type,t=g.has(e),n=qe.getClearColor(),r=qe.getClearAlpha(),i=n.r,a=n.g,o=n.b;t?(_[0]=i,_[1]=a,_[2]=o,_[3]=r,L.clearBufferuiv(L.COLOR,0,_)):(v[0]=i,v[1]=a,v[2]=o,v[3]=r,L.clearBufferiv(L.COLOR,0,v))}else r|=L.COLOR_BUFFER_BIT}t&&(r|=L.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),n&&(r|=L.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),r!==0&&L.clear(r)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(e){e.setRenderer(this),D=e},this.dispose=function(){t.removeEventListener(`webglcontextlost`,nt,!1),t.removeEventListener(`webglcontextrestored`,rt,!1),t.removeEventListener(`webglcontextcreationerror`,it,!1),qe.dispose(),Ue.dispose(),We.dispose(),B.dispose(),z.dispose(),Le.dispose(),Be.dispose(),ze.dispose(),Qe.dispose(),$e.dispose(),Ve.dispose(),tt.dispose(),tt.removeEventListener(`sessionstart`,ft),tt.removeEventListener(`sessionend`,pt),mt.stop()};function nt(e){e.preventDefault(),wt(`WebGLRenderer: Context Lost.`),E=!0}function rt(){wt(`WebGLRenderer: Context Restored.`),E=!1;let e=Ie.autoReset,t=Ke.enabled,n=Ke.autoUpdate,r=Ke.needsUpdate,i=Ke.type;et(),Ie.autoReset=e,Ke.enabled=t,Ke.autoUpdate=n,Ke.needsUpdate=r,Ke.type=i}function it(e){H(`WebGLRenderer: A WebGL context could not be created. Reason: `,e.statusMessage)}function at(e){let t=e.target;t.removeEventListener(`dispose`,at),ot(t)}function ot(e){st(e),z.remove(e)}function st(e){let t=z.get(e).programs;t!==void 0&&(t.forEach(function(e){Ve.releaseProgram(e)}),e.isShaderMaterial&&Ve.releaseShaderCache(e))}this.renderBufferDirect=function(e,t,n,r,i,a){t===null&&(t=Ae);let o=i.isMesh&&i.matrixWorld.determinantAffine()<0,s=kt(e,t,n,r,i);R.setMaterial(r,o);let c=n.index,l=1;if(r.wireframe===!0){if(c=ze.getWireframeAttribute(n),c===void 0)return;l=2}let u=n.drawRange,d=n.attributes.position,f=u.start*l,p=(u.start+u.count)*l;a!==null&&(f=Math.max(f,a.start*l),p=Math.min(p,(a.start+a.count)*l)),c===null?d!=null&&(f=Math.max(f,0),p=Math.min(p,d.count)):(f=Math.max(f,0),p=Math.min(p,c.count));let m=p-f;if(m<0||m===1/0)return;Qe.setup(i,r,s,n,c);let h,g=Ye;if(c!==null&&(h=Re.get(c),g=Xe,g.setIndex(h)),i.isMesh)r.wireframe===!0?(R.setLineWidth(r.wireframeLinewidth*Me()),g.setMode(L.LINES)):g.setMode(L.TRIANGLES);else if(i.isLine){let e=r.linewidth;e===void 0&&(e=1),R.setLineWidth(e*Me()),i.isLineSegments?g.setMode(L.LINES):i.isLineLoop?g.setMode(L.LINE_LOOP):g.setMode(L.LINE_STRIP)}else i.isPoints?g.setMode(L.POINTS):i.isSprite&&g.setMode(L.TRIANGLES);if(i.isBatchedMesh){if(Pe.get(`WEBGL_multi_draw`))g.renderMultiDraw(i._multiDrawStarts,i._multiDrawCounts,i._multiDrawCount);else{let e=i._multiDrawStarts,t=i._multiDrawCounts,n=i._multiDrawCount,a=c?Re.get(c).bytesPerElement:1,o=z.get(r).currentProgram.getUniforms();for(let r=0;r<n;r++)o.setValue(L,`_gl_DrawID`,r),g.render(e[r]/a,t[r])}}else if(i.isInstancedMesh)g.renderInstances(f,m,i.count);else if(n.isInstancedBufferGeometry){let e=n._maxInstanceCount===void 0?1/0:n._maxInstanceCount,t=Math.min(n.instanceCount,e);g.renderInstances(f,m,t)}else g.render(f,m)};function ct(e,t,n,r){D!==null&&e.isNodeMaterial&&D.setObject(r,e),Te===!0&&Ge.setState(e,n,!1),e.transparent===!0&&e.side===2&&e.forceSinglePass===!1?(e.side=1,e.needsUpdate=!0,Ct(e,t,r),e.side=0,e.needsUpdate=!0,Ct(e,t,r),e.side=2):Ct(e,t,r)}this.compile=function(e,t,n=null){n===null&&(n=e),D!==null&&D.renderStart(e,t,n),x=We.get(n),x.init(t),C.push(x),n.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),e!==n&&e.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),x.setupLights(),D!==null&&D.updateLights(x.state.lightsArray),Ee=this.localClippingEnabled,Te=Ge.init(this.clippingPlanes,Ee),Te===!0&&Ge.setGlobalState(this.clippingPlanes,t),D!==null&&Ke.render(x.state.shadowsArray,n,t);let r=new Set;return e.traverse(function(e){if(!(e.isMesh||e.isPoints||e.isLine||e.isSprite))return;let i=e.material;if(i){if(Array.isArray(i))for(let a=0;a<i.length;a++){let o=i[a];ct(o,n,t,e),r.add(o)}else ct(i,n,t,e),r.add(i)}}),x=C.pop(),D!==null&&D.renderEnd(),r},this.compileAsync=function(e,t,n=null){let r=this.compile(e,t,n);return new Promise(t=>{function n(){r.forEach(function(e){let t=z.get(e).currentProgram;(t===void 0||t.isReady())&&r.delete(e)}),r.size===0?t(e):setTimeout(n,10)}Pe.get(`KHR_parallel_shader_compile`)===null?setTimeout(n,10):n()})};let lt=null;function ut(e){lt&&lt(e)}function ft(){mt.stop()}function pt(){mt.start()}let mt=new Ho;mt.setAnimationLoop(ut),typeof self<`u`&&mt.setContext(self),this.setAnimationLoop=function(e){lt=e,tt.setAnimationLoop(e),e===null?mt.stop():mt.start()},tt.addEventListener(`sessionstart`,ft),tt.addEventListener(`sessionend`,pt),this.render=function(e,t){if(t!==void 0&&t.isCamera!==!0){H(`WebGLRenderer.render: camera is not an instance of THREE.Camera.`);return}if(E===!0)return;D!==null&&D.renderStart(e,t);let n=tt.enabled===!0&&tt.isPresenting===!0,r=w!==null&&(N===null||n)&&w.begin(T,N);if(e.matrixWorldAutoUpdate===!0&&e.updateMatrixWorld(),t.parent===null&&t.matrixWorldAutoUpdate===!0&&t.updateMatrixWorld(),tt.enabled===!0&&tt.isPresenting===!0&&(w===null||w.isCompositing()===!1)&&(tt.cameraAutoUpdate===!0&&tt.updateCamera(t),t=tt.getCamera()),e.isScene===!0&&e.onBeforeRender(T,e,t,N),x=We.get(e,C.length),x.init(t),x.state.textureUnits=B.getTextureUnits(),C.push(x),De.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),t.isArrayCamera?Se.setFromArrayCamera(t):be.setFromProjectionMatrix(De,vt,t.reversedDepth),Ee=this.localClippingEnabled,Te=Ge.init(this.clippingPlanes,Ee),b=Ue.get(e,S.length),b.init(),S.push(b),this.info.render.frame++,tt.enabled===!0&&tt.isPresenting===!0){let e=T.xr.getDepthSensingMesh();e!==null&&ht(e,t,-1/0,T.sortObjects)}ht(e,t,0,T.sortObjects),b.finish(),D!==null&&D.updateLights(x.state.lightsArray),T.sortObjects===!0&&b.sort(he,ge),je=tt.enabled===!1||tt.isPresenting===!1||tt.hasDepthSensing()===!1,je&&qe.addToRenderList(b,e),this.info.autoReset===!0&&this.info.reset(),Te===!0&&Ge.beginShadows();let i=x.state.shadowsArray;if(Ke.render(i,e,t),Te===!0&&Ge.endShadows(),(r&&w.hasRenderPass())===!1){let n=b.opaque,r=b.transmissive;if(x.setupLights(),t.isArrayCamera){let i=t.cameras;if(r.length>0)for(let t=0,a=i.length;t<a;t++){let a=i[t];_t(n,r,e,a)}je&&qe.render(e);for(let t=0,n=i.length;t<n;t++){let n=i[t];gt(b,e,n,n.viewport)}}else r.length>0&&_t(n,r,e,t),je&&qe.render(e),gt(b,e,t)}N!==null&&M===0&&(B.updateMultisampleRenderTarget(N),B.updateRenderTargetMipmap(N)),r&&w.end(T),e.isScene===!0&&e.onAfterRender(T,e,t),Qe.resetDefaultState(),ee=-1,te=null,C.pop(),C.length>0?(x=C[C.length-1],B.setTextureUnits(x.state.textureUnits),Te===!0&&Ge.setGlobalState(T.clippingPlanes,x.state.camera)):x=null,S.pop(),b=S.length>0?S[S.length-1]:null,D!==null&&D.renderEnd()};function ht(e,t,n,r){if(e.visible===!1)return;if(e.layers.test(t.layers)){if(e.isGroup)n=e.renderOrder;else if(e.isLOD)e.autoUpdate===!0&&e.update(t);else if(e.isLight)x.pushLight(e),e.castShadow&&x.pushShadow(e);else if(e.isSprite){let i=t.isArrayCamera?Se:be;if(!e.frustumCulled||e.intersectsFrustum(i)){r&&ke.setFromMatrixPosition(e.matrixWorld).applyMatrix4(De);let i=Be.update(e),a=e.material;a.visible&&b.push(e,i,a,n,ke.z,null,t)}}else if(e.isMesh||e.isLine||e.isPoints){let i=t.isArrayCamera?Se:be;if(!e.frustumCulled||e.intersectsFrustum(i)){let i=Be.update(e),a=e.material;if(r&&(e.boundingSphere===void 0?(i.boundingSphere===null&&i.computeBoundingSphere(),ke.copy(i.boundingSphere.center)):(e.boundingSphere===null&&e.computeBoundingSphere(),ke.copy(e.boundingSphere.center)),ke.applyMatrix4(e.matrixWorld).applyMatrix4(De)),Array.isArray(a)){let r=i.groups;for(let o=0,s=r.length;o<s;o++){let s=r[o],c=a[s.materialIndex];c&&c.visible&&b.push(e,i,c,n,ke.z,s,t)}}else a.visible&&b.push(e,i,a,n,ke.z,null,t)}}}let i=e.children;for(let e=0,a=i.length;e<a;e++)ht(i[e],t,n,r)}function gt(e,t,n,r){let{opaque:i,transmissive:a,transparent:o}=e;x.setupLightsView(n),Te===!0&&Ge.setGlobalState(T.clippingPlanes,n),r&&R.viewport(P.copy(r)),i.length>0&&yt(i,t,n),a.length>0&&yt(a,t,n),o.length>0&&yt(o,t,n),R.buffers.depth.setTest(!0),R.buffers.depth.setMask(!0),R.buffers.color.setMask(!0),R.setPolygonOffset(!1)}function _t(e,t,n,r){if((n.isScene===!0?n.overrideMaterial:null)!==null)return;if(x.state.transmissionRenderTarget[r.id]===void 0){let e=Pe.has(`EXT_color_buffer_half_float`)||Pe.has(`EXT_color_buffer_float`);x.state.transmissionRenderTarget[r.id]=new Sn(1,1,{generateMipmaps:!0,type:e?le:ie,minFilter:re,samples:Math.max(4,Fe.samples),stencilBuffer:i,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:q.workingColorSpace})}let a=x.state.transmissionRenderTarget[r.id],o=r.viewport||P;a.setSize(o.z*T.transmissionResolutionScale,o.w*T.transmissionResolutionScale);let s=T.getRenderTarget(),c=T.getActiveCubeFace(),l=T.getActiveMipmapLevel();T.setRenderTarget(a),T.getClearColor(oe),ce=T.getClearAlpha(),ce<1&&T.setClearColor(16777215,.5),T.clear(),je&&qe.render(n);let u=T.toneMapping;T.toneMapping=0;let d=r.viewport;if(r.viewport!==void 0&&(r.viewport=void 0),x.setupLightsView(r),Te===!0&&Ge.setGlobalState(T.clippingPlanes,r),yt(e,n,r),B.updateMultisampleRenderTarget(a),B.updateRenderTargetMipmap(a),Pe.has(`WEBGL_multisampled_render_to_texture`)===!1){let e=!1;for(let i=0,a=t.length;i<a;i++){let{object:a,geometry:o,material:s,group:c}=t[i];if(s.side===2&&a.layers.test(r.layers)){let t=s.side;s.side=1,s.needsUpdate=!0,bt(a,n,r,o,s,c),s.side=t,s.needsUpdate=!0,e=!0}}e===!0&&(B.updateMultisampleRenderTarget(a),B.updateRenderTargetMipmap(a))}T.setRenderTarget(s,c,l),T.setClearColor(oe,ce),d!==void 0&&(r.viewport=d),T.toneMapping=u}function yt(e,t,n){let r=t.isScene===!0?t.overrideMaterial:null;for(let i=0,a=e.length;i<a;i++){let a=e[i],{object:o,geometry:s,group:c}=a,l=a.material;l.allowOverride===!0&&r!==null&&(l=r),o.layers.test(n.layers)&&bt(o,t,n,s,l,c)}}function bt(e,t,n,r,i,a){D!==null&&i.isNodeMaterial&&D.setObject(e,i),e.onBeforeRender(T,t,n,r,i,a),e.modelViewMatrix.multiplyMatrices(n.matrixWorldInverse,e.matrixWorld),e.normalMatrix.getNormalMatrix(e.modelViewMatrix),i.onBeforeRender(T,t,n,r,e,a),i.transparent===!0&&i.side===2&&i.forceSinglePass===!1?(i.side=1,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=0,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=2):T.renderBufferDirect(n,t,r,i,e,a),e.onAfterRender(T,t,n,r,i,a)}function xt(e){let t=0;for(let n of e)n.texture!==null&&t++;return t}function Ct(e,t,n){t.isScene!==!0&&(t=Ae);let r=z.get(e),i=x.state.lights,a=x.state.shadowsArray,o=i.state.version,s=Ve.getParameters(e,i.state,a,t,n,x.state.lightProbeGridArray),c=Ve.getProgramCacheKey(s),l=r.programs;r.environment=e.isMeshStandardMaterial||e.isMeshLambertMaterial||e.isMeshPhongMaterial?t.environment:null,r.fog=t.fog;let u=e.isMeshStandardMaterial||e.isMeshLambertMaterial&&!e.envMap||e.isMeshPhongMaterial&&!e.envMap;r.envMap=Le.get(e.envMap||r.environment,u),r.envMapRotation=r.environment!==null&&e.envMap===null?t.environmentRotation:e.envMapRotation,l===void 0&&(e.addEventListener(`dispose`,at),l=new Map,r.programs=l,r.programVariants=new Map);let d=l.get(c);if(d!==void 0){if(r.currentProgram===d&&r.lightsStateVersion===o)return Ot(e,s),d}else s.uniforms=Ve.getUniforms(e),D!==null&&e.isNodeMaterial&&D.build(e,n,s),e.onBeforeCompile(s,T),d=Ve.acquireProgram(s,c),l.set(c,d),r.uniforms=s.uniforms;let f=r.uniforms;return(!e.isShaderMaterial&&!e.isRawShaderMaterial||e.clipping===!0)&&(f.clippingPlanes=Ge.uniform),Ot(e,s),r.needsLights=jt(e),r.lightsStateVersion=o,r.needsLights&&(f.ambientLightColor.value=i.state.ambient,f.lightProbe.value=i.state.probe,f.sunLights.value=i.state.sun,f.sunLightShadows.value=i.state.sunShadow,f.directionalLights.value=i.state.directional,f.directionalLightShadows.value=i.state.directionalShadow,f.spotLights.value=i.state.spot,f.spotLightShadows.value=i.state.spotShadow,f.rectAreaLights.value=i.state.rectArea,f.ltc_1.value=i.state.rectAreaLTC1,f.ltc_2.value=i.state.rectAreaLTC2,f.pointLights.value=i.state.point,f.pointLightShadows.value=i.state.pointShadow,f.hemisphereLights.value=i.state.hemi,f.sunShadowMatrix.value=i.state.sunShadowMatrix,f.sunShadowCascade.value=i.state.sunShadowCascade,f.directionalShadowMatrix.value=i.state.directionalShadowMatrix,f.spotLightMatrix.value=i.state.spotLightMatrix,f.spotLightMap.value=i.state.spotLightMap,f.pointShadowMatrix.value=i.state.pointShadowMatrix),r.numLightProbeGrids=xt(x.state.lightProbeGridArray),r.currentProgram=d,r.uniformsList=null,d}function Tt(e,t,n,r,i){let a=z.get(e),o=a.currentProgram.id+`,`+r+`,`+i,s=a.programVariants.get(o);return s===void 0?(s=Ct(e,t,n),a.programVariants.set(o,s)):(a.currentProgram=s,a.uniformsList=null,a.outputColorSpace=r,a.toneMapping=i),s}function Et(e){if(e.uniformsList===null){let t=e.currentProgram.getUniforms();e.uniformsList=Nc.seqWithValue(t.seq,e.uniforms)}return e.uniformsList}function Ot(e,t){let n=z.get(e);n.outputColorSpace=t.outputColorSpace,n.batching=t.batching,n.batchingColor=t.batchingColor,n.instancing=t.instancing,n.instancingColor=t.instancingColor,n.instancingMorph=t.instancingMorph,n.skinning=t.skinning,n.morphTargets=t.morphTargets,n.morphNormals=t.morphNormals,n.morphColors=t.morphColors,n.morphTargetsCount=t.morphTargetsCount,n.numClippingPlanes=t.numClippingPlanes,n.numIntersection=t.numClipIntersection,n.vertexAlphas=t.vertexAlphas,n.vertexTangents=t.vertexTangents,n.toneMapping=t.toneMapping}function kt(e,t,n,r,i){t.isScene!==!0&&(t=Ae),B.resetTextureUnits();let a=t.fog,o=r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial?t.environment:null,s=N===null?T.outputColorSpace:N.isXRRenderTarget===!0?N.texture.colorSpace:q.workingColorSpace,c=r.isMeshStandardMaterial||r.isMeshLambertMaterial&&!r.envMap||r.isMeshPhongMaterial&&!r.envMap,l=Le.get(r.envMap||o,c),u=r.vertexColors===!0&&!!n.attributes.color&&n.attributes.color.itemSize===4,d=!!n.attributes.tangent&&(!!r.normalMap||r.anisotropy>0),f=!!n.morphAttributes.position,p=!!n.morphAttributes.normal,m=!!n.morphAttributes.color,h=0;r.toneMapped&&(N===null||N.isXRRenderTarget===!0)&&(h=T.toneMapping);let g=n.morphAttributes.position||n.morphAttributes.normal||n.morphAttributes.color,_=g===void 0?0:g.length,v=z.get(r),b=x.state.lights;if(Te===!0&&(Ee===!0||e!==te)){let t=e===te&&r.id===ee;Ge.setState(r,e,t)}let S=!1,C=!1;r.version===v.__version?v.needsLights&&v.lightsStateVersion!==b.state.version||i.isBatchedMesh&&v.batching===!1||!i.isBatchedMesh&&v.batching===!0||i.isBatchedMesh&&v.batchingColor===!0&&i._colorsTexture===null||i.isBatchedMesh&&v.batchingColor===!1&&i._colorsTexture!==null||i.isInstancedMesh&&v.instancing===!1||!i.isInstancedMesh&&v.instancing===!0||i.isSkinnedMesh&&v.skinning===!1||!i.isSkinnedMesh&&v.skinning===!0||i.isInstancedMesh&&v.instancingColor===!0&&i.instanceColor===null||i.isInstancedMesh&&v.instancingColor===!1&&i.instanceColor!==null||i.isInstancedMesh&&v.instancingMorph===!0&&i.morphTexture===null||i.isInstancedMesh&&v.instancingMorph===!1&&i.morphTexture!==null?S=!0:v.envMap===l?r.fog===!0&&v.fog!==a||v.numClippingPlanes!==void 0&&(v.numClippingPlanes!==Ge.numPlanes||v.numIntersection!==Ge.numIntersection)?S=!0:v.vertexAlphas===u&&v.vertexTangents===d&&v.morphTargets===f&&v.morphNormals===p&&v.morphColors===m&&v.morphTargetsCount===_&&v.numLightProbeGrids===xt(x.state.lightProbeGridArray)?(v.outputColorSpace!==s||v.toneMapping!==h)&&(C=!0):S=!0:S=!0:(S=!0,v.__version=r.version);let w=v.currentProgram;(S===!0||C===!0)&&(w=C===!0?Tt(r,t,i,s,h):Ct(r,t,i),D&&r.isNodeMaterial&&D.onUpdateProgram(r,w,v));let E=!1,O=!1,k=!1,A=w.getUniforms(),j=v.uniforms;if(R.useProgram(w.program)&&(E=!0,O=!0,k=!0),r.id!==ee&&(ee=r.id,O=!0),E||te!==e){R.buffers.depth.getReversed()&&e.reversedDepth!==!0&&(e._reversedDepth=!0,e.updateProjectionMatrix()),A.setValue(L,`projectionMatrix`,e.projectionMatrix),A.setValue(L,`viewMatrix`,e.matrixWorldInverse);let t=A.map.cameraPosition;t!==void 0&&t.setValue(L,Oe.setFromMatrixPosition(e.matrixWorld)),Fe.logarithmicDepthBuffer&&A.setValue(L,`logDepthBufFC`,2/(Math.log(e.far+1)/Math.LN2)),(r.isMeshPhongMaterial||r.isMeshToonMaterial||r.isMeshLambertMaterial||r.isMeshBasicMaterial||r.isMeshStandardMaterial||r.isShaderMaterial)&&A.setValue(L,`isOrthographic`,e.isOrthographicCamera===!0),te!==e&&(te=e,O=!0,k=!0)}if(v.needsLights&&(b.state.sunShadowMap.length>0&&A.setValue(L,`sunShadowMap`,b.state.sunShadowMap,B),b.state.directionalShadowMap.length>0&&A.setValue(L,`directionalShadowMap`,b.state.directionalShadowMap,B),b.state.spotShadowMap.length>0&&A.setValue(L,`spotShadowMap`,b.state.spotShadowMap,B),b.state.pointShadowMap.length>0&&A.setValue(L,`pointShadowMap`,b.state.pointShadowMap,B)),i.isSkinnedMesh){A.setOptional(L,i,`bindMatrix`),A.setOptional(L,i,`bindMatrixInverse`);let e=i.skeleton;e&&(e.boneTexture===null&&e.computeBoneTexture(),A.setValue(L,`boneTexture`,e.boneTexture,B))}i.isBatchedMesh&&(A.setOptional(L,i,`batchingTexture`),A.setValue(L,`batchingTexture`,i._matricesTexture,B),A.setOptional(L,i,`batchingIdTexture`),A.setValue(L,`batchingIdTexture`,i._indirectTexture,B),A.setOptional(L,i,`batchingColorTexture`),i._colorsTexture!==null&&A.setValue(L,`batchingColorTexture`,i._colorsTexture,B));let M=n.morphAttributes;if((M.position!==void 0||M.normal!==void 0||M.color!==void 0)&&Je.update(i,n,w),(O||v.receiveShadow!==i.receiveShadow)&&(v.receiveShadow=i.receiveShadow,A.setValue(L,`receiveShadow`,i.receiveShadow)),(r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial)&&r.envMap===null&&t.environment!==null&&(j.envMapIntensity.value=t.environmentIntensity),j.dfgLUT!==void 0&&(j.dfgLUT.value=Xl()),O){if(A.setValue(L,`toneMappingExposure`,T.toneMappingExposure),v.needsLights&&At(j,k),a&&r.fog===!0&&He.refreshFogUniforms(j,a),He.refreshMaterialUniforms(j,r,me,pe,x.state.transmissionRenderTarget[e.id]),v.needsLights&&v.numLightProbeGrids>0){let e=y,t=0;for(let n of x.state.lightProbeGridArray)n.texture!==null&&(e.textures[t]=n.texture,e.min[t]=n.boundingBox.min,e.max[t]=n.boundingBox.max,e.resolution[t]=n.resolution,t++);for(let n in e)e[n].length=t;j.probesSH.value=e.textures,j.probesMin.value=e.min,j.probesMax.value=e.max,j.probesResolution.value=e.resolution}Nc.upload(L,Et(v),j,B)}if(r.isShaderMaterial&&r.uniformsNeedUpdate===!0&&(Nc.upload(L,Et(v),j,B),r.uniformsNeedUpdate=!1),r.isSpriteMaterial&&A.setValue(L,`center`,i.center),A.setValue(L,`modelViewMatrix`,i.modelViewMatrix),A.setValue(L,`normalMatrix`,i.normalMatrix),A.setValue(L,`modelMatrix`,i.matrixWorld),r.uniformsGroups!==void 0){let e=r.uniformsGroups;for(let t=0,n=e.length;t<n;t++){let n=e[t];$e.update(n,w),$e.bind(n,w)}}return w}function At(e,t){e.ambientLightColor.needsUpdate=t,e.lightProbe.needsUpdate=t,e.sunLights.needsUpdate=t,e.sunLightShadows.needsUpdate=t,e.directionalLights.needsUpdate=t,e.directionalLightShadows.needsUpdate=t,e.pointLights.needsUpdate=t,e.pointLightShadows.needsUpdate=t,e.spotLights.needsUpdate=t,e.spotLightShadows.needsUpdate=t,e.rectAreaLights.needsUpdate=t,e.hemisphereLights.needsUpdate=t}function jt(e){return e.isMeshLambertMaterial||e.isMeshToonMaterial||e.isMeshPhongMaterial||e.isMeshStandardMaterial||e.isShadowMaterial||e.isShaderMaterial&&e.lights===!0}this.getActiveCubeFace=function(){return j},this.getActiveMipmapLevel=function(){return M},this.getRenderTarget=function(){return N},this.setRenderTargetTextures=function(e,t,n){let r=z.get(e);r.__autoAllocateDepthBuffer=e.resolveDepthBuffer===!1,r.__autoAllocateDepthBuffer===!1&&(r.__useRenderToTexture=!1),z.get(e.texture).__webglTexture=t,z.get(e.depthTexture).__webglTexture=r.__autoAllocateDepthBuffer?void 0:n,r.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(e,t){let n=z.get(e);n.__webglFramebuffer=t,n.__useDefaultFramebuffer=t===void 0},this.setRenderTarget=function(e,t=0,n=0){N=e,j=t,M=n;let r=null,i=!1,a=!1;if(e){let o=z.get(e);if(o.__useDefaultFramebuffer!==void 0){R.bindFramebuffer(L.FRAMEBUFFER,o.__webglFramebuffer),P.copy(e.viewport),ne.copy(e.scissor),ae=e.scissorTest,R.viewport(P),R.scissor(ne),R.setScissorTest(ae),ee=-1;return}if(o.__webglFramebuffer===void 0)B.setupRenderTarget(e);else if(o.__hasExternalTextures)B.rebindTextures(e,z.get(e.texture).__webglTexture,z.get(e.depthTexture).__webglTexture);else if(e.depthBuffer){let t=e.depthTexture;if(o.__boundDepthTexture!==t){if(t!==null&&z.has(t)&&(e.width!==t.image.width||e.height!==t.image.height))throw Error(`THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.`);B.setupDepthRenderbuffer(e)}}let s=e.texture;(s.isData3DTexture||s.isDataArrayTexture||s.isCompressedArrayTexture)&&(a=!0);let c=z.get(e).__webglFramebuffer;e.isWebGLCubeRenderTarget?(r=Array.isArray(c[t])?c[t][n]:c[t],i=!0):r=e.samples>0&&B.useMultisampledRTT(e)===!1?z.get(e).__webglMultisampledFramebuffer:Array.isArray(c)?c[n]:c,P.copy(e.viewport),ne.copy(e.scissor),ae=e.scissorTest}else P.copy(_e).multiplyScalar(me).floor(),ne.copy(ve).multiplyScalar(me).floor(),ae=ye;if(n!==0&&(r=O),R.bindFramebuffer(L.FRAMEBUFFER,r)&&R.drawBuffers(e,r),R.viewport(P),R.scissor(ne),R.setScissorTest(ae),i){let r=z.get(e.texture);L.framebufferTexture2D(L.FRAMEBUFFER,L.COLOR_ATTACHMENT0,L.TEXTURE_CUBE_MAP_POSITIVE_X+t,r.__webglTexture,n)}else if(a){let r=t;for(let t=0;t<e.textures.length;t++){let i=z.get(e.textures[t]);L.framebufferTextureLayer(L.FRAMEBUFFER,L.COLOR_ATTACHMENT0+t,i.__webglTexture,n,r)}}else if(e!==null&&n!==0){let t=z.get(e.texture);L.framebufferTexture2D(L.FRAMEBUFFER,L.COLOR_ATTACHMENT0,L.TEXTURE_2D,t.__webglTexture,n)}ee=-1};function Mt(e){let t=z.get(e);return(t.__readFormat!==e.format||t.__readType!==e.type)&&(t.__readFormat=e.format,t.__readType=e.type,t.__formatReadable=Fe.textureFormatReadable(e.format),t.__typeReadable=Fe.textureTypeReadable(e.type)),t}this.readRenderTargetPixels=function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget)){H(`WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);return}let c=z.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){R.bindFramebuffer(L.FRAMEBUFFER,c);try{let o=e.textures[s],c=o.format,l=o.type;e.textures.length>1&&L.readBuffer(L.COLOR_ATTACHMENT0+s);let u=Mt(o);if(u.__formatReadable===!1){H(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.`);return}if(u.__typeReadable===!1){H(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.`);return}t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i&&L.readPixels(t,n,r,i,Ze.convert(c),Ze.convert(l),a)}finally{let e=N===null?null:z.get(N).__webglFramebuffer;R.bindFramebuffer(L.FRAMEBUFFER,e)}}},this.readRenderTargetPixelsAsync=async function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget))throw Error(`THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);let c=z.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){if(t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i){R.bindFramebuffer(L.FRAMEBUFFER,c);let o=e.textures[s],l=o.format,u=o.type;e.textures.length>1&&L.readBuffer(L.COLOR_ATTACHMENT0+s);let d=Mt(o);if(d.__formatReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.`);if(d.__typeReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.`);let f=L.createBuffer();L.bindBuffer(L.PIXEL_PACK_BUFFER,f),L.bufferData(L.PIXEL_PACK_BUFFER,a.byteLength,L.STREAM_READ),L.readPixels(t,n,r,i,Ze.convert(l),Ze.convert(u),0),L.bindBuffer(L.PIXEL_PACK_BUFFER,null);let p=N===null?null:z.get(N).__webglFramebuffer;R.bindFramebuffer(L.FRAMEBUFFER,p);let m=L.fenceSync(L.SYNC_GPU_COMMANDS_COMPLETE,0);return L.flush(),await Dt(L,m,4),L.bindBuffer(L.PIXEL_PACK_BUFFER,f),L.getBufferSubData(L.PIXEL_PACK_BUFFER,0,a),L.bindBuffer(L.PIXEL_PACK_BUFFER,null),L.deleteBuffer(f),L.deleteSync(m),a}throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.`)}},this.copyFramebufferToTexture=function(e,t=null,n=0){let r=2**-n,i=Math.floor(e.image.width*r),a=Math.floor(e.image.height*r),o=t===null?0:t.x,s=t===null?0:t.y;B.setTexture2D(e,0),L.copyTexSubImage2D(L.TEXTURE_2D,n,0,0,o,s,i,a),R.unbindTexture()},this.copyTextureToTexture=function(e,t,n=null,r=null,i=0,a=0){let o,s,c,l,u,d,f,p,m,h=e.isCompressedTexture?e.mipmaps[a]:e.image;if(n!==null)o=n.max.x-n.min.x,s=n.max.y-n.min.y,c=n.isBox3?n.max.z-n.min.z:1,l=n.min.x,u=n.min.y,d=n.isBox3?n.min.z:0;else{let t=2**-i;o=Math.floor(h.width*t),s=Math.floor(h.height*t),c=e.isDataArrayTexture?h.depth:e.isData3DTexture?Math.floor(h.depth*t):1,l=0,u=0,d=0}r===null?(f=0,p=0,m=0):(f=r.x,p=r.y,m=r.z);let g=Ze.convert(t.format),_=Ze.convert(t.type),v;t.isData3DTexture?(B.setTexture3D(t,0),v=L.TEXTURE_3D):t.isDataArrayTexture||t.isCompressedArrayTexture?(B.setTexture2DArray(t,0),v=L.TEXTURE_2D_ARRAY):(B.setTexture2D(t,0),v=L.TEXTURE_2D),R.activeTexture(L.TEXTURE0),R.pixelStorei(L.UNPACK_FLIP_Y_WEBGL,t.flipY),R.pixelStorei(L.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),R.pixelStorei(L.UNPACK_ALIGNMENT,t.unpackAlignment);let y=R.getParameter(L.UNPACK_ROW_LENGTH),b=R.getParameter(L.UNPACK_IMAGE_HEIGHT),x=R.getParameter(L.UNPACK_SKIP_PIXELS),S=R.getParameter(L.UNPACK_SKIP_ROWS),C=R.getParameter(L.UNPACK_SKIP_IMAGES);R.pixelStorei(L.UNPACK_ROW_LENGTH,h.width),R.pixelStorei(L.UNPACK_IMAGE_HEIGHT,h.height),R.pixelStorei(L.UNPACK_SKIP_PIXELS,l),R.pixelStorei(L.UNPACK_SKIP_ROWS,u),R.pixelStorei(L.UNPACK_SKIP_IMAGES,d);let w=e.isDataArrayTexture||e.isData3DTexture,T=t.isDataArrayTexture||t.isData3DTexture;if(e.isDepthTexture){let n=z.get(e),r=z.get(t),h=z.get(n.__renderTarget),g=z.get(r.__renderTarget);R.bindFramebuffer(L.READ_FRAMEBUFFER,h.__webglFramebuffer),R.bindFramebuffer(L.DRAW_FRAMEBUFFER,g.__webglFramebuffer);for(let n=0;n<c;n++)w&&(L.framebufferTextureLayer(L.READ_FRAMEBUFFER,L.COLOR_ATTACHMENT0,z.get(e).__webglTexture,i,d+n),L.framebufferTextureLayer(L.DRAW_FRAMEBUFFER,L.COLOR_ATTACHMENT0,z.get(t).__webglTexture,a,m+n)),L.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,L.DEPTH_BUFFER_BIT,L.NEAREST);R.bindFramebuffer(L.READ_FRAMEBUFFER,null),R.bindFramebuffer(L.DRAW_FRAMEBUFFER,null)}else if(i!==0||e.isRenderTargetTexture||z.has(e)){let n=z.get(e),r=z.get(t);R.bindFramebuffer(L.READ_FRAMEBUFFER,k),R.bindFramebuffer(L.DRAW_FRAMEBUFFER,A);for(let e=0;e<c;e++)w?L.framebufferTextureLayer(L.READ_FRAMEBUFFER,L.COLOR_ATTACHMENT0,n.__webglTexture,i,d+e):L.framebufferTexture2D(L.READ_FRAMEBUFFER,L.COLOR_ATTACHMENT0,L.TEXTURE_2D,n.__webglTexture,i),T?L.framebufferTextureLayer(L.DRAW_FRAMEBUFFER,L.COLOR_ATTACHMENT0,r.__webglTexture,a,m+e):L.framebufferTexture2D(L.DRAW_FRAMEBUFFER,L.COLOR_ATTACHMENT0,L.TEXTURE_2D,r.__webglTexture,a),i===0?T?L.copyTexSubImage3D(v,a,f,p,m+e,l,u,o,s):L.copyTexSubImage2D(v,a,f,p,l,u,o,s):L.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,L.COLOR_BUFFER_BIT,L.NEAREST);R.bindFramebuffer(L.READ_FRAMEBUFFER,null),R.bindFramebuffer(L.DRAW_FRAMEBUFFER,null)}else T?e.isDataTexture||e.isData3DTexture?L.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h.data):t.isCompressedArrayTexture?L.compressedTexSubImage3D(v,a,f,p,m,o,s,c,g,h.data):L.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h):e.isDataTexture?L.texSubImage2D(L.TEXTURE_2D,a,f,p,o,s,g,_,h.data):e.isCompressedTexture?L.compressedTexSubImage2D(L.TEXTURE_2D,a,f,p,h.width,h.height,g,h.data):L.texSubImage2D(L.TEXTURE_2D,a,f,p,o,s,g,_,h);R.pixelStorei(L.UNPACK_ROW_LENGTH,y),R.pixelStorei(L.UNPACK_IMAGE_HEIGHT,b),R.pixelStorei(L.UNPACK_SKIP_PIXELS,x),R.pixelStorei(L.UNPACK_SKIP_ROWS,S),R.pixelStorei(L.UNPACK_SKIP_IMAGES,C),a===0&&t.generateMipmaps===!0&&t.mipmapsAutoUpdate===!0&&L.generateMipmap(v),R.unbindTexture()},this.initRenderTarget=function(e){z.get(e).__webglFramebuffer===void 0&&B.setupRenderTarget(e)},this.initTexture=function(e){e.isCubeTexture?B.setTextureCube(e,0):e.isData3DTexture?B.setTexture3D(e,0):e.isDataArrayTexture||e.isCompressedArrayTexture?B.setTexture2DArray(e,0):B.setTexture2D(e,0),R.unbindTexture()},this.resetState=function(){j=0,M=0,N=null,R.reset(),Qe.reset()},typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}get coordinateSystem(){return vt}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=q._getDrawingBufferColorSpace(e),t.unpackColorSpace=q._getUnpackColorSpace()}},Ql=40*Math.PI/180,$l=Math.PI/2-1e-4,eu=.05,tu=4e3;function nu(e){let{azimuth:t,elevation:n}=e;return{back:[Math.cos(n)*Math.cos(t),Math.cos(n)*Math.sin(t),Math.sin(n)],right:[-Math.sin(t),Math.cos(t),0],up:[-Math.sin(n)*Math.cos(t),-Math.sin(n)*Math.sin(t),Math.cos(n)]}}function ru(e){return fu(e.target,nu(e).back,e.distance)}function iu(e){return e.distance*Math.tan(Ql/2)}function au(e,t,n){let r=Math.min(Math.max(e.elevation+n,-$l),$l);return{...e,azimuth:e.azimuth+t,elevation:r}}function ou(e,t,n){let r=nu(e),i=2*iu(e),a=fu(fu(e.target,r.right,-t*i),r.up,-n*i);return{...e,target:a}}function su(e,t,n){let r=Math.min(Math.max(e.distance*t,eu),tu),i=r/e.distance,a=(n??e.target).map((t,n)=>t+(e.target[n]-t)*i);return{...e,distance:r,target:a}}function cu(e,t,n,r){let i=t.map((e,t)=>(e+n[t])/2),{back:a,right:o,up:s}=nu(e),c=Math.tan(Ql/2),l=eu;for(let u=0;u<8;u++){let d=i.map((e,r)=>(u>>r&1?n[r]:t[r])-e),f=Math.abs(pu(d,o))/(c*r),p=Math.abs(pu(d,s))/c;l=Math.max(l,Math.max(f,p)+(e.ortho?0:pu(d,a)))}return{...e,target:i,distance:l*1.04}}function lu(e,t,n){let r=n*n*(3-2*n),i=(e,t)=>e+(t-e)*r,a=uu(t.azimuth-e.azimuth);return{target:e.target.map((e,n)=>i(e,t.target[n])),azimuth:e.azimuth+a*r,elevation:i(e.elevation,t.elevation),distance:Math.exp(i(Math.log(e.distance),Math.log(t.distance))),ortho:t.ortho}}function uu(e){let t=2*Math.PI;return((e+Math.PI)%t+t)%t-Math.PI}function du(e,t,n,r,i){let{back:a,right:o,up:s}=nu(e),c=(2*t/r-1)*(r/i),l=1-2*n/i,u=iu(e);if(e.ortho)return{from:fu(fu(fu(e.target,o,c*u),s,l*u),a,tu/4),direction:fu([0,0,0],a,-1)};let d=Math.tan(Ql/2),f=fu(fu(fu([0,0,0],a,-1),o,c*d),s,l*d);return{from:ru(e),direction:f}}function fu(e,t,n){return[e[0]+t[0]*n,e[1]+t[1]*n,e[2]+t[2]*n]}function pu(e,t){return e[0]*t[0]+e[1]*t[1]+e[2]*t[2]}var mu=`
in vec4 light; // sky, block, corner, own
in vec4 colour; // tint, shade
in vec4 kind; // texture; class + 256 * cuts, its own and of what lies on it
uniform int hiddenClasses;
uniform int hiddenCuts;
uniform vec3 skyLight;
uniform vec3 lampLight;
uniform vec3 ambient;
uniform float corner;
uniform float curve;
uniform float tall; // of the picture, in pixels
in vec3 outward;
out vec2 at;
flat out float layer;
out vec3 tint;
float shine(float level) {
  float share = min(level * (255.0 / 60.0), 1.0);
  return share / (1.0 + curve * (1.0 - share));
}
bool isOff(float told) {
  int facts = int(told + 0.5);
  return ((1 << (facts & 255)) & hiddenClasses) != 0 || ((facts >> 8) & hiddenCuts) != 0;
}
void main() {
  bool hidden = isOff(kind.y) || (kind.z < 65534.5 && !isOff(kind.z));
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  float pixel = 2.0 * (projectionMatrix * place).w / (projectionMatrix[1][1] * tall);
  vec3 away = mat3(modelViewMatrix) * outward;
  float reach = length(away);
  if (reach > 0.0) place.xyz += away * (max(pixel, 0.0) * 0.12 / reach);
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * place;
  at = uv;
  layer = kind.x;
  vec3 lit = ambient + max(skyLight * shine(light.x), lampLight * shine(light.y));
  lit *= colour.a * (1.0 - corner * light.z * (255.0 / 80.0));
  tint = colour.rgb * max(lit, vec3(light.w * 1.12));
}
`,hu=`
uniform sampler2DArray textures;
uniform bool clear;
in vec2 at;
flat in float layer;
in vec3 tint;
out vec4 painted;
void main() {
  vec4 texel = texture(textures, vec3(at, layer));
  if (clear ? texel.a < 0.02 : texel.a < 0.5) discard;
  painted = vec4(texel.rgb * tint, clear ? texel.a : 1.0);
}
`,gu=[`even`,`day`,`night`],_u={even:{sky:[0,0,0],lamp:[0,0,0],ambient:[1.1,1.1,1.1],corner:.15},day:{sky:[1,1,1],lamp:[.95,.82,.6],ambient:[.1,.1,.1],corner:.2},night:{sky:[.13,.15,.26],lamp:[.95,.82,.6],ambient:[.05,.05,.07],corner:.2}},vu={even:9418992,day:9418992,night:725030},yu=class{light=`even`;uniforms={textures:{value:null},hiddenClasses:{value:0},hiddenCuts:{value:0},skyLight:{value:new G},lampLight:{value:new G},ambient:{value:new G},corner:{value:0},curve:{value:.525},tall:{value:1e3}};solid=this.made(!1);clear=this.made(!0);constructor(){this.setLight(this.light)}setLight(e){this.light=e;let{sky:t,lamp:n,ambient:r,corner:i}=_u[e];this.uniforms.skyLight.value.fromArray(t),this.uniforms.lampLight.value.fromArray(n),this.uniforms.ambient.value.fromArray(r),this.uniforms.corner.value=i}setTextures(e,t,n){let r=new Cn(e,t,t,n);r.wrapS=r.wrapT=A,r.magFilter=N,r.minFilter=ee,r.generateMipmaps=!0,r.needsUpdate=!0,this.uniforms.textures.value?.dispose(),this.uniforms.textures.value=r}dispose(){this.uniforms.textures.value?.dispose(),this.solid.dispose(),this.clear.dispose()}made(e){return new Pa({glslVersion:_t,vertexShader:mu,fragmentShader:hu,uniforms:{...this.uniforms,clear:{value:e}},transparent:e,depthWrite:!e})}},bu={object:16765503,block:0},xu=.004,Su=new W,Cu=class{group=new Qn;material=new yu;hidden={classes:0,cuts:0};mesh=null;drawn=null;outlines=new Map;toGrid=new Y;constructor(){this.group.matrixAutoUpdate=!1,this.group.visible=!1}show(e){this.mesh=e,this.group.matrix.fromArray(e.facts.grid_to_room).transpose(),this.group.updateMatrixWorld(!0),this.toGrid=this.group.matrix.clone().invert(),this.material.setTextures(e.texels,e.facts.texture_px,e.layers),this.drawn?.geometry.dispose(),this.drawn?.removeFromParent(),this.drawn=new Oi(wu(e),[this.material.solid,this.material.clear]),this.drawn.frustumCulled=!1,this.drawn.geometry.boundingSphere=new Kr,this.drawn.onBeforeRender=e=>{this.material.uniforms.tall.value=e.getDrawingBufferSize(Su).y},this.group.add(this.drawn)}hide(e){this.hidden=e,this.material.uniforms.hiddenClasses.value=e.classes,this.material.uniforms.hiddenCuts.value=e.cuts}meet(e,t){let n=new G(...e).applyMatrix4(this.toGrid),r=new G(...e).add(new G(...t)).applyMatrix4(this.toGrid);return this.mesh?.meet(n.toArray(),r.sub(n).toArray(),this.hidden)??null}toRoom(e){return new G(...e).applyMatrix4(this.group.matrix).toArray()}outline(e,t){let n=this.outlines.get(e);n?.geometry.dispose(),n?.removeFromParent();let r=new aa(new ei().setAttribute(`position`,new Hr(t.flatMap(Du),3)),new qi({color:bu[e]}));r.frustumCulled=!1,this.outlines.set(e,r),this.group.add(r)}};function wu(e){let t=new ei;t.setAttribute(`position`,new zr(e.position,3)),t.setAttribute(`uv`,new zr(e.uv,2)),t.setAttribute(`light`,new zr(e.light,4,!0)),t.setAttribute(`colour`,new zr(e.colour,4,!0)),t.setAttribute(`kind`,new zr(e.kind,4)),t.setAttribute(`outward`,new zr(Tu(e),4,!0));let n=new Uint32Array(e.quads*6);for(let t=0;t<e.quads;t++){let[r,i,a,o]=Eu(e,t);n.set([r,i,a,r,a,o],t*6)}t.setIndex(new zr(n,1));let r=e.facts.clear_from*6;return t.addGroup(0,r,0),t.addGroup(r,n.length-r,1),t}function Tu({position:e,quads:t,facts:n}){let r=new Int8Array(t*16);for(let t=0;t<n.clear_from;t++){let n=(n,r)=>{let i=[0,1,2].map(i=>e[t*12+r*3+i]-e[t*12+n*3+i]),a=Math.hypot(...i)||1;return i.map(e=>e/a*63)},i=n(0,1),a=n(0,3);for(let e=0;e<3;e++){let[n,o]=[i[e],a[e]];r.set([-n-o],t*16+e),r.set([n-o],t*16+4+e),r.set([n+o],t*16+8+e),r.set([o-n],t*16+12+e)}}return r}function Eu({light:e},t){let n=t*4,r=t=>e[(n+t)*4+2];return r(0)+r(2)>r(1)+r(3)?[n+1,n+2,n+3,n]:[n,n+1,n+2,n+3]}function Du({low:e,high:t}){let n=[e.map(e=>e-xu),t.map(e=>e+xu)],r=[];for(let e=0;e<3;e++)for(let t=0;t<4;t++){let i=r=>[0,1,2].map(i=>{let a=i===(e+1)%3?t&1:t>>1;return n[i===e?r:a][i]});r.push(...i(0),...i(1))}return r}var Ou={u1:Uint8Array,u2:Uint16Array,i4:Int32Array,f4:Float32Array},ku=class e{told;rows;data;begin;constructor(e,t,n,r){this.told=e,this.rows=t,this.data=n,this.begin=r}static read(t,n){let r=new Uint8Array(t,0,4);if(String.fromCharCode(...r)!==n)throw Error(`not ${n}`);let i=new DataView(t).getUint32(4,!0),a=new TextDecoder().decode(new Uint8Array(t,8,i)),{arrays:o,...s}=JSON.parse(a);return new e(s,o,t,8+i)}array(e){let t=this.rows[e],n=t&&Ou[t.dtype];if(!n)throw Error(`no array ${e}`);let r=t.shape.reduce((e,t)=>e*t,1);return{values:new n(this.data,this.begin+t.offset,r),shape:t.shape}}},Au=65535,ju=class e{facts;layers;position;uv;light;colour;kind;state;instance;texels;constructor(e,t,n){this.facts=e,this.layers=n,this.position=t.position,this.uv=t.uv,this.light=t.light,this.colour=t.colour,this.kind=t.kind,this.state=t.state,this.instance=t.instance,this.texels=t.texels}static read(t){let n=ku.read(t,`W2MB`),r=e=>n.array(e).values,i={position:r(`position`),uv:r(`uv`),light:r(`light`),colour:r(`colour`),kind:r(`kind`),state:r(`state`),instance:r(`instance`),texels:r(`texels`)};return new e(n.told,i,n.array(`texels`).shape[0]??0)}get quads(){return this.state.length}isHidden(e,t){let n=this.kind[e*16+2];return Mu(this.kind[e*16+1],t)||n!==Au&&!Mu(n,t)}meet(e,t,n){let r=-1,i=1/0;for(let a=0;a<this.quads;a++){let o=this.distance(a,e,t);o<i&&!this.isHidden(a,n)&&([r,i]=[a,o])}return r<0?null:{quad:r,t:i,cell:this.cellAt(r,e,t,i)}}boxOf(e){let t=[1/0,1/0,1/0],n=[-1/0,-1/0,-1/0];for(let r=0;r<this.quads;r++)if(this.instance[r]===e)for(let e=r*12;e<r*12+12;e++){let r=e%3;t[r]=Math.min(t[r],this.position[e]),n[r]=Math.max(n[r],this.position[e])}return t[0]<=n[0]?{low:t,high:n}:null}distance(e,t,n){let r=this.position,i=e*12,a=r[i+3]-r[i],o=r[i+4]-r[i+1],s=r[i+5]-r[i+2],c=r[i+9]-r[i],l=r[i+10]-r[i+1],u=r[i+11]-r[i+2],d=o*u-s*l,f=s*c-a*u,p=a*l-o*c,m=d*n[0]+f*n[1]+p*n[2];if(m>=0)return 1/0;let h=t[0]-r[i],g=t[1]-r[i+1],_=t[2]-r[i+2],v=-(d*h+f*g+p*_)/m;if(v<=0)return 1/0;let y=h+v*n[0],b=g+v*n[1],x=_+v*n[2],S=(y*a+b*o+x*s)/(a*a+o*o+s*s),C=(y*c+b*l+x*u)/(c*c+l*l+u*u);return S>=0&&S<=1&&C>=0&&C<=1?v:1/0}cellAt(e,t,n,r){let i=this.inward(e);return t.map((e,t)=>Math.floor(e+r*n[t]+i[t]*.01))}inward(e){let t=t=>{let n=e*12+t*3;return[this.position[n],this.position[n+1],this.position[n+2]]},[n,r,i]=[t(0),t(1),t(3)],a=r.map((e,t)=>e-n[t]),o=i.map((e,t)=>e-n[t]),s=[o[1]*a[2]-o[2]*a[1],o[2]*a[0]-o[0]*a[2],o[0]*a[1]-o[1]*a[0]],c=Math.hypot(...s)||1;return s.map(e=>e/c)}};function Mu(e,{classes:t,cuts:n}){return!!(1<<(e&255)&t)||!!(e>>8&n)}function Nu(e){let[t,n]=[e[0],-e[1]];return 1<<(t>0?2:0)+ +(n>0)|32}var Pu=300,Fu=class{app;wish={size:4,style:`blocks`};mesh=null;busy=!1;got=``;running=null;timer=0;listeners=new Set;waiting=[];constructor(e){this.app=e}watch(e){this.listeners.add(e)}get key(){let{scene:e}=this.app.store.get();return e?[e.document,e.rev,this.wish.size,this.wish.style].join():``}get isFresh(){return this.got===this.key}refresh(e=!1){clearTimeout(this.timer),(!this.isFresh||this.busy)&&(this.timer=window.setTimeout(()=>void this.load(),e?0:Pu),this.busy=!0,this.tell())}idle(){return new Promise(e=>{this.busy?this.waiting.push(e):e()})}async load(){this.running?.abort();let e=this.running=new AbortController,{size:t,style:r}=this.wish,i=this.key;try{let n=await fetch(`api/build?blocks_per_metre=${t}&style=${r}`,e);if(!n.ok)throw Error((await n.json()).error);let a=ju.read(await n.arrayBuffer());if(e.signal.aborted)return;this.mesh=a;let[o,,...s]=i.split(`,`);this.got=[o,a.facts.rev,...s].join()}catch(t){if(e.signal.aborted)return;this.got=i,this.app.toast(t instanceof Error?t.message:n.build.failed,`error`)}if(this.busy=!1,this.tell(),this.key!==this.got)this.refresh();else for(let e of this.waiting.splice(0))e()}tell(){for(let e of this.listeners)e()}},Iu=1,Lu=12,Ru=class{app;blocks=new Cu;loader;view;cutOpen=!0;clicked=null;wanted=!1;whole=!1;listeners=new Set;constructor(e){this.app=e,this.view=e.view,this.loader=new Fu(e),this.view.scene.add(this.blocks.group),this.view.onFrame.push(()=>this.wanted&&this.hide()),this.loader.watch(()=>this.take()),e.store.watch([`scene`,`touched`],()=>this.wanted&&this.loader.refresh()),e.store.watch([`view`],()=>this.wanted&&this.hide()),e.store.watch([`selectedObjects`,`objects`],()=>this.outline())}watch(e){this.listeners.add(e)}show(e,t=!1){this.wanted=e,this.whole=t,e&&this.loader.refresh(!0),this.click(null),this.outline(),this.swap(),this.hide()}wish(e){this.loader.wish={...this.loader.wish,...e},this.click(null),this.wanted&&this.loader.refresh(!0),this.tell()}setCutOpen(e){this.cutOpen=e,this.hide(),this.tell()}clickAt(e,t){let n=this.rayAt(e,t),r=n&&this.blocks.meet(n.from,n.direction);this.click(r?this.factsOf(r):null);let{objects:i}=this.app.store.get(),a=this.clicked?.object??0;this.app.store.set({selectedObjects:new Set(i.has(a)?[a]:[])})}ahead(e,t){let n=this.blocks.meet(e,t);return n&&this.factsOf(n)}factsOf({quad:e,cell:t}){let n=this.blocks.mesh;return{state:n.facts.palette[n.state[e]]??``,cell:t,object:n.instance[e]}}click(e){this.clicked=e;let t=e?.state&&{low:e.cell,high:e.cell.map(e=>e+1)};this.blocks.outline(`block`,t?[t]:[]),this.tell(),this.view.invalidate()}take(){let{mesh:e}=this.loader;e&&e!==this.blocks.mesh&&(this.blocks.show(e),this.click(null),this.outline(),this.swap(),this.hide()),this.tell()}swap(){let e=this.wanted&&this.blocks.mesh!==null;this.blocks.group.visible=e,this.view.showCells(!e),this.view.picker=e?e=>this.pick(e.from,e.direction):null}hide(){let{view:e}=this.app.store.get(),t={classes:this.whole?0:zu(e),cuts:this.whole?0:this.cuts(e)},{classes:n,cuts:r}=this.blocks.hidden;(t.classes!==n||t.cuts!==r)&&(this.blocks.hide(t),this.view.invalidate())}cuts(e){let t=e.hidden.has(Iu)?16:0,n=this.view.orbit;return this.cutOpen&&!this.isInside(ru(n))?Nu(nu(n).back)|t:t}isInside(e){let{scene:t}=this.app.store.get();return t?e.every((e,n)=>{let r=t.origin_m[n];return e>r&&e<r+t.shape[n]*t.voxel_m}):!1}outline(){let{mesh:e}=this.blocks,{selectedObjects:t}=this.app.store.get(),n=e&&!this.whole?[...t].flatMap(t=>e.boxOf(t)??[]):[];this.blocks.outline(`object`,n),this.view.invalidate()}rayAt(e,t){let n=null,{picker:r}=this.view;return this.view.picker=e=>(n=e,null),this.view.pick(e,t),this.view.picker=r,n}pick(e,t){let{scene:n}=this.app.store.get(),r=this.blocks.meet(e,t);if(!r||!n)return null;let i=r.t+.01/new G(...t).length(),a=e.map((e,r)=>{let a=(e+i*t[r]-n.origin_m[r])/n.voxel_m;return Math.min(Math.max(Math.floor(a),0),n.shape[r]-1)}),o=(a[0]*n.shape[1]+a[1])*n.shape[2]+a[2],s=this.factsOf(r).object;return{cell:a,flat:o,face:2,t:r.t,...s&&{object:s}}}tell(){for(let e of this.listeners)e()}};function zu(e){let t=0;for(let n=0;n<Lu;n++)(e.solo===null?e.hidden.has(n):n!==e.solo)&&(t|=1<<n);return t}function Bu(e){if(!e)return{name:n.build.display,id:`minecraft:block_display`,facts:[]};let[t=``,r=``]=e.split(`[`),i=(t.split(`:`)[1]??t).replaceAll(`_`,` `),a=r.replace(`]`,``).split(`,`).filter(e=>e&&e!==`waterlogged=false`).map(e=>e.split(`=`));return{name:i.charAt(0).toUpperCase()+i.slice(1),id:t,facts:a}}var Vu=[`blocks`,`display`,`voxels`],Hu=4,Uu=new WeakMap;function Wu(e){let t=Uu.get(e);if(t)return t;let n=new Ru(e);return Uu.set(e,n),Yu(e,n),n}function Gu(){w(`build`,{enter:e=>Wu(e).show(!0),leave:e=>Wu(e).show(!1)}),T({id:`build`,title:n.build.title,place:`right`,modes:[`build`,`walk`],order:10,mount:Ku}),T({id:`block`,title:n.build.block,place:`right`,modes:[`build`],order:20,mount:qu}),E({id:`building`,mount:Ju})}function Ku(e,t){let r=Wu(t),{loader:i,blocks:a}=r,o=n.build,s=()=>1/(t.store.get().scene?.voxel_m??.08),l=()=>[1,2,4,s()],u=g(o.size,()=>l().map(e=>({value:String(e),label:o.sizes(e,e===s())})),e=>r.wish({size:Number(e)})),d=g(o.style,()=>Vu.map(e=>({value:e,label:o.styles[e]})),e=>r.wish({style:e})),f=g(o.light,()=>gu.map(e=>({value:e,label:o.lights[e]})),e=>{a.material.setLight(e),r.view.invalidate(),y()}),p=_(o.cutOpen,`cut-open`,e=>r.setCutOpen(e)),m=c(`p`,{class:`note`,data:{build:`facts`}}),h=(e,t)=>[c(`h3`,{class:`sub`},e),t],v=[h(o.size,u.node),h(o.style,d.node),h(o.light,f.node)].flat();e.append(c(`div`,{class:`wishes`},...v,p.node,m));let y=()=>{u.set(String(i.wish.size)),d.set(i.wish.style),f.set(a.material.light),p.set(r.cutOpen);let{mesh:e}=i;m.textContent=e?o.facts(e.facts.blocks,e.facts.palette.length-1):``};r.watch(y),t.store.watch([`scene`],y)}function qu(e,t){let r=Wu(t),{actions:a}=t,o=c(`div`,{class:`stack`,data:{build:`block`}});e.append(o);let s=()=>{let{clicked:e}=r;if(!e){u(o,c(`p`,{class:`note`},n.build.click));return}let{name:s,id:l,facts:d}=Bu(e.state),f=t.store.get().objects.get(e.object),p=d.map(([e,t])=>c(`div`,{class:`block-fact`},c(`dt`,{},e),c(`dd`,{},t)));u(o,c(`strong`,{data:{build:`name`}},s),c(`code`,{class:`block-id`},l),p.length>0&&c(`dl`,{class:`block-facts`},...p),c(`p`,{data:{build:`object`}},n.build.partOf(f&&i(f))),f?.placements[0]&&c(`p`,{class:`note`},n.templateName(f.placements[0].template)),f&&c(`div`,{class:`row is-even`},a.button(`object.turnBack`,{icon:`turnBack`}),a.button(`object.turn`,{icon:`turn`})),f&&c(`div`,{class:`row is-even`},a.button(`object.templateBack`,{label:n.inspector.previous}),a.button(`object.template`,{label:n.inspector.next})))};r.watch(s),t.store.watch([`objects`],s)}function Ju(e,t){let r=Wu(t),i=c(`div`,{class:`building`,role:`status`,hidden:!0},n.build.busy);e.append(i);let a=()=>{let{mode:e}=t.store.get();i.hidden=!r.loader.busy||e!==`build`&&e!==`walk`};r.watch(a),t.store.watch([`mode`],a)}function Yu(e,t){let n=null,r=t=>{let{mode:n,tool:r}=e.store.get();return n===`build`&&r===`navigate`&&t.button===0};e.canvas.addEventListener(`pointerdown`,e=>{n=r(e)?[e.offsetX,e.offsetY]:null}),e.canvas.addEventListener(`pointerup`,e=>{n&&r(e)&&(Math.hypot(e.offsetX-n[0],e.offsetY-n[1])<Hu&&t.clickAt(e.offsetX,e.offsetY),n=null)})}async function Xu(e){return rd(await nd(fetch(e)))}async function Zu(e,t={},n=`POST`){return rd(await nd(fetch(e,{method:n,headers:{"Content-Type":`application/json`},body:JSON.stringify(t)})))}async function Qu(e,t,n={}){return rd(await nd(fetch(e,{method:`PUT`,body:t,...n})))}async function $u(e){await rd(await nd(fetch(e,{method:`DELETE`})))}var ed=class extends Error{},td=class extends Error{status;constructor(e,t){super(t),this.status=e}};async function nd(e){try{return await e}catch{throw new ed(n.error.offline)}}async function rd(e){let t=await e.json().catch(()=>({}));if(!e.ok)throw new td(e.status,t.error??`${e.status} ${e.statusText}`);return t}function id(e){return e instanceof Error?e.message:String(e)}var ad=40,od=1447899735;async function sd(e){let t=await fetch(`api/volume?what=${e}`);if(!t.ok)throw Error(`${e}: ${t.status} ${t.statusText}`);return{rev:Number(t.headers.get(`X-Rev`)),...ld(await t.arrayBuffer())}}async function cd(e){let t=await fetch(e);if(!t.ok)throw Error(`${e}: ${t.status} ${t.statusText}`);return ld(await t.arrayBuffer()).cells}function ld(e){let t=new DataView(e);if(e.byteLength<ad||t.getUint32(0,!0)!==od)throw Error(`not a volume`);if(t.getUint16(4,!0)!==1)throw Error(`a volume of another version`);let n=t.getUint8(6)===1,r=[8,12,16].map(e=>t.getUint32(e,!0)),i=r[0]*r[1]*r[2];if(e.byteLength<ad+i*(n?2:1))throw Error(`a cut volume`);return{shape:r,cells:n?new Uint16Array(e,ad,i):new Uint8Array(e,ad,i)}}var ud=255,dd=12;function fd(e,t,n=[]){let r=new Float64Array(144);n.forEach((e,t)=>r[t*dd]+=e);let i={added:[],removed:[],changed:[]},a=null;for(let n=0;n<t.length;n++){let o=t[n],s=e[n]===ud?0:e[n];o!==ud&&(r[o*dd+s]+=1);let c=o===ud||o===s?null:o===0?`added`:s===0?`removed`:`changed`;a&&c===a.kind?a.run[1]+=1:c?i[c].push((a={run:[n,1],kind:c}).run):a=null}let o=e=>i[e].reduce((e,t)=>e+t[1],0),s={added:o(`added`),removed:o(`removed`),changed:o(`changed`)};return{...i,cells:s,...pd(r)}}function pd(e){let t=(t,n)=>e[t*dd+n],n=0,r=0,i=[];for(let e=0;e<dd;e++){let a=0,o=0;for(let i=0;i<dd;i++)a+=t(e,i),o+=t(i,e),e&&i&&(n+=t(e,i)),(e||i)&&(r+=t(e,i));e&&a&&i.push(t(e,e)/(a+o-t(e,e)))}let a=i.length?i.reduce((e,t)=>e+t,0)/i.length:0;return{iou:r?n/r:0,miou:a}}var md=40,hd=[`added`,`removed`,`changed`];function gd(){T({id:`compare`,title:n.compare.title,place:`right`,modes:[`inspect`,`voxels`,`objects`],order:80,closed:!0,mount:(e,t)=>new _d(e,t)})}var _d=class{app;other=null;beyond=[];name=``;due=0;before=`class`;figures=c(`div`,{class:`compare-figures`,"aria-live":`polite`});truth;end;file=c(`input`,{type:`file`,accept:`.npz,.npy,.json`,hidden:!0,data:{pick:`compare`}});constructor(e,t){this.app=t;let r=n.compare;this.truth=v(r.truth,()=>void this.take(()=>Zu(`api/compare/truth`))),this.end=v(r.end,()=>void this.stop());let i=v(r.file,()=>this.file.click()),a=v(r.opened,()=>void this.take(()=>Zu(`api/compare/opened`)));this.file.addEventListener(`change`,()=>{let[e]=this.file.files??[],t=encodeURIComponent(e?.name??``);e&&this.take(()=>Qu(`api/upload/compare?name=${t}`,e,{method:`POST`})),this.file.value=``}),e.append(c(`p`,{class:`note`},r.lead),c(`div`,{class:`compare-choices`},this.truth,a,i,this.end,this.file),this.figures),this.show(null),t.store.watch([`scene`],({scene:e})=>e&&this.name===``&&void this.ask()),t.store.watch([`labels`,`scene`,`view`],({view:e},t)=>{(!t.has(`view`)||t.size>1||e.hidden!==this.hidden)&&this.soon(),this.hidden=e.hidden})}hidden=new Set;asked=``;async ask(){let{scene:e}=this.app.store.get();if(!e||this.asked===e.name)return;this.asked=e.name;let t=await Xu(`api/compare`).catch(()=>null);p(this.truth,t?.has_truth?``:n.compare.why.truth,n.compare.truth)}async take(e){try{let{name:t,beyond:n}=await e();this.other=await cd(`api/compare/labels`),[this.name,this.beyond]=[t,n];let{scene:r,view:i}=this.app.store.get();i.colourBy!==`difference`&&(this.before=i.colourBy),r&&this.app.store.set({scene:{...r,has:{...r.has,truth:!0}}}),this.count(),this.app.store.setView({colourBy:`difference`})}catch(e){this.app.toast(id(e),`error`)}}async stop(){this.other=null,this.name=``,this.app.view.setDifference(null),this.app.store.setView({colourBy:this.before});let{scene:e}=this.app.store.get();e&&this.app.store.set({scene:{...e,has:{...e.has,truth:!1}}}),this.show(null),await $u(`api/compare`).catch(()=>void 0)}soon(){this.other&&(clearTimeout(this.due),this.due=window.setTimeout(()=>this.count(),md))}count(){let{labels:e}=this.app.store.get();if(!this.other||this.other.length!==e.length)return;let t=fd(e,this.other,this.beyond),{hidden:n}=this.app.store.get().view;this.app.view.setDifference({...t,removed:vd(t.removed,this.other,n)}),this.show(t)}show(e){let t=n.compare;if(this.end.hidden=!e,!e){u(this.figures);return}let r=hd.map(n=>c(`div`,{class:`compare-row is-${n}`},c(`span`,{class:`compare-mark`}),c(`span`,{},t[n]),c(`output`,{data:{compared:n}},t.cells(e.cells[n]))));u(this.figures,c(`p`,{class:`compare-with`},t.with(t.names[this.name]??this.name)),c(`div`,{class:`compare-scores`},yd(t.iou,e.iou,`iou`),yd(t.miou,e.miou,`miou`)),...r)}};function vd(e,t,n){let r=[];for(let[i,a]of e)for(let e=i;e<i+a;e++){if(n.has(t[e]))continue;let i=r.at(-1);i&&i[0]+i[1]===e?i[1]+=1:r.push([e,1])}return r}function yd(e,t,r){return c(`div`,{class:`compare-score`},c(`output`,{data:{compared:r}},n.compare.percent(t)),c(`span`,{class:`note`},e))}function bd(e){let{start:t}=n;return e<55?t.seconds(Math.max(Math.ceil(e/5)*5,5)):t.minutes(Math.max(Math.round(e/60),1))}function xd(e,t){let r=c(`span`,{class:`progress-words`}),i=c(`span`,{class:`note`}),a=c(`progress`,{class:`progress-bar`,max:1,"aria-label":e});return{node:c(`div`,{class:`progress`},c(`div`,{class:`progress-head`},c(`strong`,{},e),t&&v(n.start.cancel,t)),a,c(`div`,{class:`progress-foot`},r,i)),show({stage:e,done:t,total:o,share:s,left_s:c}){let l=s??(o?t/o:null);l===null?a.removeAttribute(`value`):a.value=l;let d=o>1&&o!==100?` ${t} / ${o}`:``;u(r,`${n.start.stages[e]??e}${d}`),u(i,c===null||!e?``:n.start.left(bd(c)))},say(e){u(r,e)}}}var Sd={undo:`M7 4 3 8l4 4M3 8h8a5 5 0 0 1 0 10H8`,redo:`m13 4 4 4-4 4M17 8H9a5 5 0 0 0 0 10h3`,sun:`M10 6.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7ZM10 1.5v2M10 16.5v2M1.5 10h2M16.5 10h2M4 4l1.4 1.4M14.6 14.6 16 16M16 4l-1.4 1.4M5.4 14.6 4 16`,moon:`M16.5 12.2A7 7 0 0 1 7.8 3.500a7 7 0 1 0 8.700 8.700Z`,help:`M10 1.8a8.2 8.2 0 1 0 0 16.4 8.2 8.2 0 0 0 0-16.4ZM7.7 7.8a2.3 2.3 0 1 1 3.4 2c-.8.5-1.1.9-1.1 1.9M10 14.4v.2`,export:`M10 12V2.5M6.5 6 10 2.5 13.5 6M3.5 11v5.5h13V11`,save:`M3 3h11l3 3v11H3zM6.5 3v4.5h6V3M6 17v-6h8v6`,search:`M8.8 3.2a5.6 5.6 0 1 0 0 11.2 5.6 5.6 0 0 0 0-11.2ZM13 13l4.2 4.2`,eye:`M1.5 10S4.6 4.5 10 4.5 18.5 10 18.5 10 15.4 15.5 10 15.5 1.5 10 1.5 10ZM10 7.6a2.4 2.4 0 1 0 0 4.8 2.4 2.4 0 0 0 0-4.8Z`,eyeOff:`M3 3l14 14M8 4.8a9 9 0 0 1 2-.3c5.4 0 8.5 5.5 8.5 5.5a15 15 0 0 1-2.3 2.9M5 6.3A14 14 0 0 0 1.5 10S4.6 15.5 10 15.5a8 8 0 0 0 4-1.1`,lock:`M5 9h10v8H5zM7 9V6.5a3 3 0 0 1 6 0V9`,unlock:`M5 9h10v8H5zM7 9V6.5a3 3 0 0 1 5.8-1`,more:`M4.5 10h.1M10 10h.1M15.5 10h.1`,down:`m5 7.5 5 5 5-5`,close:`m5 5 10 10M15 5 5 15`,navigate:`m4 3 12 5.5-5.2 1.9L9 16z`,brush:`M17 3 9 11M7 12c-2.5 0-3 2-3 3.2S3 17 2.5 17c3.5 1 6.500 0 6.500-3z`,erase:`m8 16-5-5 8.500-8.500 6 6L10 16zM7 7.500l6 6M8 16.500h9.500`,box:`M3.500 5.500v-2h2M8.500 3.500h3M14.500 3.500h2v2M16.500 8.500v3M16.500 14.500v2h-2M11.500 16.500h-3M5.500 16.500h-2v-2M3.500 11.500v-3`,lasso:`M10 3.500c4.200 0 7.500 2.100 7.500 4.900S14.200 13.300 10 13.300c-.9 0-1.800-.1-2.600-.3M5 12c-1.600-.9-2.500-2.100-2.500-3.600 0-2.800 3.300-4.900 7.500-4.900M5 12.200a1.700 1.700 0 1 0 1.700 1.700c0 1.500-.7 2.600-2 3.600`,flood:`M4 4h5v5H4zM9 9h5v5H9zM4 9h5v5H4zM14.500 16.500h3`,eyedropper:`m11 5 4 4M9.500 6.500l4 4L7 17H3v-4zM12.500 3.500a2.500 2.500 0 0 1 4 4L15 9l-4-4z`,measure:`m2.500 13.500 11-11 4 4-11 11zM5.500 10.500l2 2M8.500 7.500l1.500 1.500M11.500 4.500l2 2`,move:`M10 2v16M2 10h16M7.500 4.500 10 2l2.500 2.500M7.500 15.500 10 18l2.500-2.500M4.500 7.500 2 10l2.500 2.500M15.500 7.500 18 10l-2.500 2.500`,add:`M10 4v12M4 10h12`,split:`M10 2.500v15M7 6.500 3.500 10 7 13.500M13 6.500l3.500 3.500L13 13.500`,merge:`M10 2.500v15M3 10h5M5.500 7.500 8 10l-2.500 2.500M17 10h-5M14.500 7.500 12 10l2.500 2.500`,duplicate:`M7 7h10v10H7zM4 13H3V3h10v1`,turn:`M16.500 10a6.500 6.500 0 1 1-2-4.700M15 1.800v4h-4`,turnBack:`M3.500 10a6.500 6.500 0 1 0 2-4.700M5 1.800v4h4`,trash:`M3.500 5.500h13M8 5.500v-2h4v2M5 5.500l.8 11.500h8.400L15 5.500M8.300 8.500v5.500M11.700 8.500v5.500`,floor:`M3 16.500h14M10 3v9.500M6.500 9l3.500 3.500L13.500 9`,wall:`M3.500 3v14M17 10H7.500M11 6.500 7.500 10l3.500 3.500`,focus:`M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M10 8a2 2 0 1 0 0 4 2 2 0 0 0 0-4Z`,back:`M12.500 4 6.500 10l6 6`,home:`M3 9.500 10 3l7 6.500M5 8v9h10V8`,surface:`M3 6.500 10 3l7 3.500-7 3.500zM3 10l7 3.500 7-3.500`,check:`m4 10.500 4 4 8-9`,warn:`M10 3 1.800 17h16.400zM10 8v4.500M10 14.700v.1`,template:`M3 3h6v6H3zM11 3h6v6h-6zM3 11h6v6H3zM11 14h6M14 11v6`,viewTop:`M10 3 17 6.500 10 10 3 6.500zM3 6.500v7L10 17l7-3.500v-7`,viewFront:`M3.500 6.500 10 10v7l-6.500-3.500zM3.500 6.500 10 3l6.500 3.500v7L10 17`,viewSide:`M16.500 6.500 10 10v7l6.500-3.500zM16.500 6.500 10 3 3.500 6.500v7L10 17`,ortho:`M3 3h14v14H3zM3 10h14M10 3v14`,sphere:`M10 2.500a7.500 7.500 0 1 0 0 15 7.500 7.500 0 0 0 0-15Z`,cube:`M10 2.500 16.500 6v8L10 17.500 3.500 14V6zM3.500 6l6.500 3.500L16.500 6M10 9.500v8`,folder:`M2.500 5h5.500l1.500 2h8v9.500h-15z`,photo:`M2.500 5.500h3.500l1.500-2h5l1.500 2h3.500v11h-15zM10 8a3 3 0 1 0 0 6 3 3 0 0 0 0-6Z`,video:`M2.500 5.500h10v9h-10zM12.500 9l5-2.500v7l-5-2.500`,scan:`M3 6.500V3h3.500M13.500 3H17v3.500M17 13.500V17h-3.500M6.500 17H3v-3.500M2 10h16`,frames:`M6 3h11v10H6zM3 6.500v10h11`,plan:`M3 3h14v14H3zM3 11h6M9 7.500V17M13 3v5h4`,single:`M7.500 7.500h5v5h-5z`};function Cd(e){let t=`http://www.w3.org/2000/svg`,n=document.createElementNS(t,`svg`);n.setAttribute(`viewBox`,`0 0 20 20`),n.setAttribute(`class`,`icon`),n.setAttribute(`aria-hidden`,`true`);let r=document.createElementNS(t,`path`);return r.setAttribute(`d`,Sd[e]),n.append(r),n}function wd(){let e=n.folders,t=c(`input`,{type:`text`,"aria-label":e.path,spellcheck:!1}),r=c(`ul`,{class:`folder-list`}),i=c(`p`,{class:`trouble`,role:`alert`,hidden:!0}),a=c(`dialog`,{class:`folder-picker`,"aria-label":e.title});return new Promise(o=>{let s=null,l=e=>{i.textContent=e,i.hidden=!e},d=async()=>{try{s=(await Zu(`api/games`,{folder:t.value})).id,a.close()}catch(e){l(id(e))}},f=v(e.choose,()=>void d(),`button is-main`),p=async n=>{try{let i=await Xu(`api/folders?in=${encodeURIComponent(n)}`);t.value=i.folder;let a=i.folders.map(e=>Td(e.name,()=>void p(e.path))),o=i.parent===null?[]:[Td(e.up,()=>void p(i.parent))];u(r,...o,...a),f.classList.toggle(`is-ready`,i.is_game),l(``)}catch(e){l(id(e))}};t.addEventListener(`keydown`,e=>{e.key===`Enter`&&(e.preventDefault(),p(t.value))});let m=v(n.start.cancel,()=>a.close());u(a,c(`h2`,{},e.title),c(`p`,{class:`note`},e.lead),t,r,i,c(`div`,{class:`row`},f,m)),a.addEventListener(`close`,()=>{a.remove(),o(s)}),document.body.append(a),a.showModal(),p(``)})}function Td(e,t){let n=c(`button`,{type:`button`,class:`folder-row`},Cd(`folder`),c(`span`,{},e));return n.addEventListener(`click`,t),c(`li`,{},n)}function Ed(){let e=null;E({id:`export-sheet`,mount:(t,n)=>void(e=new Dd(n))}),D({id:`sheet`,label:n.exports.menu,run:()=>void e?.open()})}var Dd=class{app;body=c(`div`,{class:`export-body`});page;told=null;scale=c(`select`,{data:{field:`export-scale`}});style=c(`select`,{data:{field:`export-style`}});version=c(`select`,{data:{field:`export-version`}});constructor(e){this.app=e;let t=n.exports,r=c(`button`,{type:`button`,class:`button icon-only`,"aria-label":t.close,title:t.close},Cd(`close`));r.addEventListener(`click`,()=>this.close()),this.page=c(`section`,{class:`sheet export`,role:`region`,"aria-label":t.title,tabindex:`-1`,hidden:!0},c(`div`,{class:`sheet-head`},c(`h2`,{},t.title),c(`span`,{class:`note`},t.lead),r),this.body),this.page.addEventListener(`keydown`,e=>{e.key===`Escape`&&(e.stopPropagation(),this.close())}),e.stage.append(this.page)}async open(){try{this.told=await Xu(`api/exports`)}catch(e){this.app.toast(id(e),`error`);return}this.fill(this.told),this.page.hidden=!1,this.page.focus()}close(){this.page.hidden=!0,this.app.canvas.focus()}fill(e){let t=n.exports,r=(e,t,n,r)=>{u(e,...t.map(e=>c(`option`,{value:String(e)},n(String(e))))),e.value=String(r)};r(this.scale,e.scales,e=>e,e.scale),r(this.style,e.styles,e=>n.start.styles[e]??e,e.styles[0]??``),r(this.version,e.versions,e=>e,e.version);let i=[`game`,`3d`,`data`].map(n=>c(`section`,{class:`export-group`},c(`h3`,{},t.groups[n]),c(`ul`,{},...e.forms.filter(e=>e.group===n).map(e=>this.formRow(e.id)))));u(this.body,c(`div`,{class:`export-choices`},c(`label`,{},c(`span`,{},n.start.size),this.scale),c(`label`,{},c(`span`,{},n.start.style),this.style),c(`label`,{},c(`span`,{},t.version),this.version)),c(`div`,{class:`export-places`},this.installPart(e),this.worldPart(e),this.serverPart()),c(`div`,{class:`export-groups`},...i))}choice(){return{blocks_per_metre:Number(this.scale.value),style:this.style.value,mc_version:this.version.value}}formRow(e){let t=n.exports,[r,i]=t.forms[e]??[e,``],a=c(`p`,{class:`note`,"aria-live":`polite`}),o=v(t.download,()=>{this.run(`api/exports`,{form:e,...this.choice()},a,e=>this.saveFile(e,a))});return o.dataset.export=e,o.setAttribute(`aria-label`,`${t.download}: ${r}`),c(`li`,{class:`export-row`},c(`div`,{},c(`strong`,{},r),i&&c(`span`,{class:`note`},i),a),o)}saveFile(e,t){let r=n.exports,i=c(`a`,{href:`api/exports/files/${e.id}`,download:e.file,hidden:!0});this.page.append(i),i.click(),i.remove();let a=n.start.megabytes(e.bytes/2**20),o=e.lost.map(([e,t])=>`${t.toLocaleString(`en`)} ${e}`).join(`, `);u(t,`${r.made(e.file,a)}; ${o?r.lost(o):r.nothingLost}`)}installPart(e){let t=n.exports,r=c(`select`,{"aria-label":t.game},...e.games.map(e=>c(`option`,{value:e.id},e.name))),i=c(`input`,{type:`text`,maxlength:60,"aria-label":t.name,value:this.app.store.get().scene?.name??``});return e.games.length?this.part(`install`,t.install,t.installLead,[[``,r],[t.name,i]],`api/install`,()=>({game:r.value,name:i.value}),e=>{let n=e;return[t.installed(n.name),t.steps(n.game,n.name),n.note].filter(Boolean).join(`. `)}):this.findGamePart()}findGamePart(){let e=n.exports,t=v(e.findGame,()=>{wd().then(e=>e?this.open():void 0)});return t.dataset.do=`find-game`,c(`details`,{class:`export-place`,open:!0},c(`summary`,{},e.install),c(`p`,{class:`note`},e.noGames),t)}worldPart(e){let t=n.exports,r=c(`select`,{"aria-label":t.worldName},...e.worlds.map(e=>c(`option`,{value:e.id},`${e.name} · ${e.game}`))),i=Od(),a=()=>({world:r.value,...i.value()}),o=e=>t.builtWorld(e.blocks.toLocaleString(`en`));return this.part(`world`,t.world,e.worlds.length?t.worldLead:t.noWorlds,e.worlds.length?[[``,r],...i.rows]:[],`api/build/world`,a,o)}serverPart(){let e=n.exports,t=c(`input`,{type:`text`,value:`localhost:25575`,"aria-label":e.address}),r=c(`input`,{type:`password`,autocomplete:`off`,"aria-label":e.password}),i=Od(),a=()=>({address:t.value,password:r.value,...i.value()}),o=t=>e.builtServer(t.commands.toLocaleString(`en`));return this.part(`server`,e.server,e.serverLead,[[e.address,t],[e.password,r],...i.rows],`api/build/server`,a,o)}part(e,t,r,i,a,o,s){let l=c(`p`,{class:`note`,"aria-live":`polite`}),d=v(e===`install`?t:n.exports.buildNow,()=>{this.run(a,{...o(),...this.choice()},l,e=>u(l,s(e)))},e===`install`?`button is-main`:`button`);return d.dataset.place=e,c(`details`,{class:`export-place`,open:e===`install`},c(`summary`,{},t),c(`p`,{class:`note`},r),...i.map(([e,t])=>c(`label`,{class:`export-field`},e&&c(`span`,{},e),t)),i.length>0&&d,l)}async run(e,t,r,i){let{connection:a}=this.app;try{u(r,`…`);let{job:o}=await Zu(e,t),s=a.onJob(e=>l(e)),c=!1,l=e=>{if(!(e.id!==o||c)){if(e.state===`running`){let t=e.left_s===null||!e.stage?``:`, ${n.start.left(bd(e.left_s))}`;u(r,`${n.start.stages[e.stage]??`…`}${t}`)}else c=!0,s(),r.classList.toggle(`is-bad`,e.state===`failed`),e.state===`done`?i(e.result):u(r,e.state===`failed`?e.note:n.start.cancelled)}},d=(await Xu(`api/jobs`)).find(e=>e.id===o);d&&d.state!==`running`&&l(d)}catch(e){u(r,id(e))}}};function Od(){let e=n.exports,t=c(`input`,{type:`text`,value:`0 64 0`,"aria-label":e.at,title:e.atHint}),r=c(`select`,{"aria-label":e.turns},...[0,1,2,3].map(e=>c(`option`,{value:String(e)},`${e*90}°`)));return{rows:[[e.at,t],[e.turns,r]],value:()=>({at:t.value.trim().split(/[\s,]+/).map(Number),turns:Number(r.value)})}}var kd=new Set([`scene`,`planes`,`pieces`,`doubts`]),Ad=400;function jd(){E({id:`scene-jobs`,mount:Md})}function Md(e,t){let n=new Map,r=new Map,i=e=>{clearTimeout(r.get(e)),r.delete(e),n.get(e)?.node.remove(),n.delete(e)},a=i=>{let a=xd(i.title,()=>t.connection.cancel(i.id));n.set(i.id,a),r.set(i.id,window.setTimeout(()=>e.append(a.node),Ad))};t.connection.onJob(e=>{kd.has(e.stage)&&(e.state===`running`?(n.has(e.id)||a(e),n.get(e.id)?.show(e)):i(e.id))})}var Nd={ArrowRight:1,ArrowLeft:-1},Pd={ArrowDown:1,ArrowUp:-1};function Fd(e,t=`button`,n=1){let r=()=>[...e.querySelectorAll(t)].filter(e=>e.offsetParent!==null),i=e=>{let t=r(),n=e??t.find(e=>e.tabIndex===0)??t[0];for(let e of t)e.tabIndex=e===n?0:-1};e.addEventListener(`focusin`,n=>{let r=n.target.closest(t);r&&e.contains(r)&&i(r)}),e.addEventListener(`keydown`,e=>{let t=r(),i=t.indexOf(document.activeElement),a=Pd[e.key],o=Nd[e.key]??(a&&a*n);if(i<0||o===void 0&&e.key!==`Home`&&e.key!==`End`)return;let s=t.length-1;t[((e.key===`Home`?0:e.key===`End`?s:i+(o??0))+t.length)%t.length]?.focus(),e.preventDefault(),e.stopPropagation()}),new MutationObserver(()=>i()).observe(e,{childList:!0,subtree:!0}),requestAnimationFrame(()=>i())}function Id(e,t){let n=e.vertical_fov_deg*Math.PI/360,r=Math.max(e.aspect/t,1);return{position:Hd(e,3),forward:Hd(e,2),up:Hd(e,1).map(e=>-e),field:2*Math.atan(Math.tan(n)*r)}}function Ld(e,t,n){let r=Math.min(n,t/e.aspect),i=r*e.aspect;return[(t-i)/2,(n-r)/2,i,r]}function Rd(e,t,n){let r=n*n*(3-2*n),i=(e,t)=>e.map((e,n)=>e+(t[n]-e)*r);return{position:i(e.position,t.position),forward:Ud(i(e.forward,t.forward),t.forward),up:Ud(i(e.up,t.up),t.up),field:e.field+(t.field-e.field)*r}}function zd({position:e,forward:t},n){return{target:e.map((e,r)=>e+t[r]*n),azimuth:Math.atan2(-t[1],-t[0]),elevation:Math.asin(Math.min(Math.max(-t[2],-1),1)),distance:n,ortho:!1}}function Bd(e,t){let n=[];for(let r of e){let e=t*Math.tan(r.vertical_fov_deg*Math.PI/360),i=e*r.aspect,a=Hd(r,3),o=[[-1,-1],[1,-1],[1,1],[-1,1]].map(([n,a])=>Vd(r,[n*i,a*e,t]));o.forEach((e,t)=>n.push(...a,...e,...e,...o[(t+1)%4]))}return Float32Array.from(n)}function Vd(e,[t,n,r]){return[0,1,2].map(i=>{let[a,o,s,c]=e.camera_to_room[i];return a*t+o*n+s*r+c})}function Hd(e,t){return[0,1,2].map(n=>e.camera_to_room[n][t])}function Ud(e,t){let n=Math.hypot(...e);return n>1e-6?e.map(e=>e/n):t}var Wd=[`photo`,`blend`,`beside`,`scene`],Gd=420,Kd=2,qd=.16,Jd={all:7315416,chosen:16753981},Yd=class{app;changed;frame=null;way=`photo`;blend=.5;classes=!1;picture=c(`img`,{class:`photo-over`,alt:``,hidden:!0});lines=new aa(new ei,new qi({color:Jd.all}));chosen=new aa(new ei,new qi({color:Jd.chosen,depthTest:!1}));flight=0;constructor(e,t){this.app=e,this.changed=t;let{stage:n,canvas:r,view:i}=e;r.after(this.picture);for(let e of[this.lines,this.chosen])e.visible=!1,e.frustumCulled=!1,i.scene.add(e);new ResizeObserver(()=>this.lay()).observe(n),r.addEventListener(`pointerdown`,e=>this.takenUp(e),!0),r.addEventListener(`wheel`,()=>this.leave(),{capture:!0,passive:!0}),document.addEventListener(`keydown`,e=>e.key===`Escape`&&this.leave(),!0),e.store.watch([`mode`],({mode:e})=>e===`walk`&&this.leave())}cameras(e,t){Zd(this.lines,t?e:[]),this.app.view.invalidate()}open(e){let{view:t}=this.app,n=t.pose??Xd(t.orbit);this.frame=e,this.load(),Zd(this.chosen,[e]),this.chosen.visible=!1,this.lay(),this.fly(n),this.changed()}set(e,t=this.blend){this.frame&&(this.way=e,this.blend=t,this.lay(),this.stand(),this.changed())}showClasses(e){this.classes=e,this.load()}next(){this.set(Wd[(Wd.indexOf(this.way)+1)%Wd.length])}leave(){if(!this.frame)return;cancelAnimationFrame(this.flight);let{view:e}=this.app,t=e.pose;Zd(this.chosen,[this.frame]),this.chosen.visible=!0,this.frame=null,this.lay(),e.pose=null,t&&(e.orbit=zd(t,Kd)),this.changed()}load(){if(!this.frame)return;let e=this.classes&&!this.frame.is_depth?`classes`:`picture`;this.picture.src=`api/photos/${this.frame.n}/${e}.jpg`}takenUp(e){(e.button!==0||this.app.store.get().tool===`navigate`)&&this.leave()}lay(){let{stage:e,canvas:t}=this.app,{frame:n,picture:r}=this,i=n!==null&&this.way===`beside`;if(e.classList.toggle(`is-beside`,i),r.hidden=!n||this.way===`scene`,!n)return;let[a,o,s,c]=Ld(n,i?e.clientWidth/2:t.clientWidth,t.clientHeight),l={left:a,top:o,width:s,height:c};for(let[e,t]of Object.entries(l))r.style.setProperty(e,`${t}px`);r.style.setProperty(`opacity`,String(this.way===`blend`?this.blend:1))}stand(){let{view:e,canvas:t}=this.app;this.frame&&(e.pose=Id(this.frame,t.clientWidth/Math.max(t.clientHeight,1)))}fly(e){cancelAnimationFrame(this.flight);let t=matchMedia(`(prefers-reduced-motion: reduce)`).matches,n=performance.now(),r=i=>{let{frame:a}=this,{view:o,canvas:s}=this.app;if(!a)return;let c=t?1:Math.min(Math.max((i-n)/Gd,0),1);o.pose=Rd(e,Id(a,s.clientWidth/Math.max(s.clientHeight,1)),c),this.picture.style.setProperty(`visibility`,c<1?`hidden`:`visible`),c<1&&(this.flight=requestAnimationFrame(r))};r(n)}};function Xd(e){let{back:t,up:n}=nu(e);return{position:ru(e),forward:t.map(e=>-e),up:n,field:Ql}}function Zd(e,t){e.geometry.dispose(),e.geometry=new ei,e.geometry.setAttribute(`position`,new zr(Bd(t,qd),3)),e.visible=t.length>0}function Qd(){T({id:`photos`,title:n.photos.title,place:`drawer`,modes:[`inspect`,`voxels`,`objects`,`build`],order:10,mount:(e,t)=>new $d(e,t)})}var $d=class{app;frames=[];loaded=``;list=c(`div`,{class:`photo-list`,role:`toolbar`,"aria-label":n.photos.title});note=c(`p`,{class:`note`});tools=c(`div`,{class:`photo-tools`});viewer;constructor(e,t){this.app=t,this.viewer=new Yd(t,()=>this.show()),e.append(c(`div`,{class:`photo-strip`},this.tools,this.list)),this.makeTools(),new IntersectionObserver(e=>{e.some(e=>e.isIntersecting)&&this.load()}).observe(e);let r=()=>this.viewer.frame?``:n.photos.why;t.actions.on(`photo.way`,{run:()=>this.viewer.next(),why:r}),t.actions.on(`photo.leave`,{run:()=>this.viewer.leave(),why:r})}async load(){let e=this.app.store.get().scene?.name??``;if(e&&this.loaded!==e){this.loaded=e,u(this.note,n.photos.loading);try{let e=await Xu(`api/photos`);this.frames=e.frames,u(this.note,e.why||n.photos.count(e.frames.length))}catch(e){this.loaded=``,u(this.note,id(e))}u(this.list,...this.frames.map(e=>this.thumb(e))),Fd(this.list),this.show()}}thumb(e){let t=n.photos.fly(e.name),r=c(`img`,{src:`api/photos/${e.n}/small.jpg`,alt:t,loading:`lazy`}),i=c(`button`,{type:`button`,class:`photo`,title:t,data:{photo:String(e.n)}},r);return i.addEventListener(`click`,()=>this.viewer.open(e)),i}makeTools(){let e=n.photos,t=g(e.title,()=>Wd.map(t=>({value:t,label:e.ways[t]??t})),e=>this.viewer.set(e)),r=h({label:e.blend,min:0,max:1,step:.05,show:e=>n.percent(e),change:e=>this.viewer.set(`blend`,e),id:`photo-blend`}),i=_(e.cameras,`photo-cameras`,e=>this.viewer.cameras(this.frames,e)),a=_(e.classes,`photo-classes`,e=>this.viewer.showClasses(e)),o=v(e.leave,()=>this.viewer.leave());this.showTools=()=>{let{frame:e,way:n}=this.viewer;t.node.hidden=a.node.hidden=o.hidden=!e,r.node.hidden=!e||n!==`blend`,t.set(n),r.set(this.viewer.blend)},this.tools.append(this.note,i.node,t.node,r.node,a.node,o),this.showTools()}showTools=()=>void 0;show(){this.showTools();let e=this.viewer.frame?.n;for(let t of this.list.querySelectorAll(`[data-photo]`)){let n=t.dataset.photo===String(e);t.setAttribute(`aria-pressed`,String(n)),n&&t.scrollIntoView({block:`nearest`,inline:`nearest`})}}};function ef(e,t,r){let i=n.start,a=e.scale,o=e.styles[0]??`blocks`,s=c(`p`,{class:`note`}),l=c(`p`,{class:`note`}),d=g(i.size,()=>e.scales.map(e=>({value:String(e),label:i.sizeNames[String(e)]??String(e)})),e=>{a=Number(e),m()}),f=g(i.style,()=>e.styles.map(e=>({value:e,label:i.styles[e]??e})),e=>{o=e,m()}),p=tf(e,r),m=()=>{d.set(String(a)),f.set(o),u(s,i.sizes[String(a)]),u(l,i.styleHints[o]),r()},h=c(`section`,{class:`choices`,"aria-label":i.choices},c(`h3`,{},i.choices),c(`div`,{class:`choice`},c(`span`,{class:`choice-name`},i.size),d.node,s),c(`div`,{class:`choice`},c(`span`,{class:`choice-name`},i.style),f.node,l),!t.has_scale&&p.node);return queueMicrotask(m),{node:h,choice:()=>({blocks_per_metre:a,style:o,known:t.has_scale?null:p.value()}),why:()=>t.has_scale?``:p.why()}}function tf(e,t){let r=n.start,i=Object.keys(e.known).map(e=>c(`option`,{value:e},e)),a=c(`select`,{"aria-label":r.known,data:{field:`known`}},c(`option`,{value:``},r.knownNone),...i),o=c(`input`,{type:`number`,step:.01,min:.02,max:40,"aria-label":r.knownMetres,data:{field:`metres`}});o.hidden=!0,a.addEventListener(`change`,()=>{let n=e.known[a.value];o.hidden=!n,n&&([o.min,o.max]=[String(n[0]),String(n[1])]),n&&o.focus(),t()}),o.addEventListener(`input`,t);let s=()=>a.value&&o.valueAsNumber>0?[a.value,o.valueAsNumber]:null;return{node:c(`div`,{class:`choice`},c(`span`,{class:`choice-name`},r.known),c(`div`,{class:`row`},a,o),c(`p`,{class:`note`},r.knownHint)),value:s,why:()=>a.value&&!s()?r.why.known:``}}function nf(e,t,r,i){let a=n.start.finished,o=c(`p`,{class:`note`,"aria-live":`polite`}),s=e=>u(o,e),l=v(a.edit,i,`button is-main is-large`);l.dataset.do=`open`;let d=c(`a`,{class:`button is-large`,href:`api/start/rooms/${e}/report`,target:`_blank`,rel:`noopener`},a.report),f=v(a.install,()=>void af(e,r,s),`button is-large`);f.dataset.do=`install`;let p=v(a.share,()=>void rf(e,t,r,o),`button is-large`);return p.dataset.do=`share`,c(`section`,{class:`finished`,"aria-label":a.title},c(`img`,{class:`finished-picture`,src:`api/start/rooms/${e}/picture`,alt:a.alt(t)}),c(`div`,{class:`row`},l,d,p,f),o)}async function rf(e,t,r,i){let a=n.start.finished;try{u(i,a.sharing);let{job:o}=await Zu(`api/start/rooms/${e}/share`,{title:t}),s=await of(o,r);if(s.state!==`done`)throw Error(s.note||n.start.cancelled);let l=s.result,d=c(`a`,{href:`api/exports/files/${l.id}`,download:l.file},a.shared(l.file,n.start.megabytes(l.bytes/2**20)));u(i,d),d.click()}catch(e){u(i,id(e))}}async function af(e,t,r){let i=n.exports;try{let{games:a}=await Xu(`api/exports`),o=a[0]?.id??await wd();if(!o)return;let{job:s}=await Zu(`api/start/rooms/${e}/install`,{game:o}),c=await of(s,t);if(c.state!==`done`)throw Error(c.note||n.start.cancelled);let l=c.result;r([i.installed(l.name),i.steps(l.game,l.name),l.note].filter(Boolean).join(`. `))}catch(e){r(id(e))}}function of(e,t){return new Promise((n,r)=>{let i=t=>{t.id===e&&t.state!==`running`&&(a(),n(t))},a=t.on(i);Xu(`api/jobs`).then(e=>e.forEach(i),r)})}var sf={ok:`check`,warn:`warn`,stop:`close`},cf=[`stop`,`warn`,`ok`];function lf(e){let t=[...e.doubts].sort((e,t)=>cf.indexOf(e.level)-cf.indexOf(t.level)).map(df);return c(`section`,{class:`survey`,"aria-label":n.start.found},c(`h3`,{},n.start.found),c(`p`,{class:`survey-called`},`${e.called}, ${n.start.about(bd(e.about_s))}`),t.length>0&&c(`ul`,{class:`doubts`},...t))}function uf(e,t){let n=t.lines.map(([e,t])=>[c(`dt`,{},e),c(`dd`,{},t)]).flat();return c(`section`,{class:`survey`},t.kind===`frames`&&c(`a`,{class:`survey-picture`,href:ff(e.id),target:`_blank`,rel:`noopener`},c(`img`,{src:ff(e.id),alt:t.called,width:1600,height:1040})),c(`dl`,{class:`facts`},...n))}function df(e){return c(`li`,{class:`doubt is-${e.level}`},Cd(sf[e.level]),c(`div`,{},c(`span`,{},e.text),e.level!==`ok`&&e.advice&&c(`p`,{class:`note`},e.advice)))}function ff(e){return`api/start/captures/${e}/picture.png`}var pf=Math.PI,mf=.0013,hf=class{canvas;holder;claims=()=>!1;drag=null;fingers=new Map;ends=[];constructor(e,t){this.canvas=e,this.holder=t,this.on(`pointerdown`,e=>this.down(e)),this.on(`pointermove`,e=>this.move(e)),this.on(`pointerup`,e=>this.up(e)),this.on(`pointercancel`,e=>this.up(e)),this.on(`wheel`,e=>this.wheel(e),{passive:!1}),this.on(`contextmenu`,e=>e.preventDefault())}get dragging(){return this.drag!==null}dispose(){for(let e of this.ends)e()}on(e,t,n){this.canvas.addEventListener(e,t,n),this.ends.push(()=>this.canvas.removeEventListener(e,t,n))}down(e){if(e.pointerType===`touch`&&this.fingers.set(e.pointerId,{x:e.clientX,y:e.clientY}),this.drag||e.button>2||e.button===0&&this.claims(e))return;let t=e.button===1||e.button===0&&e.shiftKey;this.drag={id:e.pointerId,x:e.clientX,y:e.clientY,pan:t};try{this.canvas.setPointerCapture(e.pointerId)}catch{}e.button===1&&e.preventDefault()}move(e){if(this.drag&&this.fingers.size===2&&this.fingers.has(e.pointerId))return this.pinch(e);let t=this.drag;if(!t||e.pointerId!==t.id)return;let n=(e.clientX-t.x)/this.canvas.clientHeight,r=(e.clientY-t.y)/this.canvas.clientHeight;t.x=e.clientX,t.y=e.clientY;let{orbit:i}=this.holder;this.holder.orbit=t.pan?ou(i,n,-r):au(i,-n*pf,r*pf)}up(e){let t=this.fingers.size===2&&this.fingers.has(e.pointerId);this.fingers.delete(e.pointerId),(e.pointerId===this.drag?.id||t)&&(this.drag=null)}pinch(e){let t=this.fingers.get(e.pointerId),[n,r]=[...this.fingers].find(([t])=>t!==e.pointerId),i={x:e.clientX,y:e.clientY};this.fingers.set(e.pointerId,i),this.fingers.set(n,r);let a=this.canvas.getBoundingClientRect(),o=e=>Math.max(Math.hypot(e.x-r.x,e.y-r.y),1),s=ou(this.holder.orbit,(i.x-t.x)/2/a.height,(t.y-i.y)/2/a.height),c=this.holder.pointAt((i.x+r.x)/2-a.left,(i.y+r.y)/2-a.top);this.holder.orbit=su(s,o(t)/o(i),c)}wheel(e){if(e.preventDefault(),e.ctrlKey&&!this.isPinch(e))return;let t=e.deltaMode===WheelEvent.DOM_DELTA_LINE?33:1,n=Math.max(-240,Math.min(240,e.deltaY*t)),r=this.canvas.getBoundingClientRect(),i=this.holder.pointAt(e.clientX-r.left,e.clientY-r.top);this.holder.orbit=su(this.holder.orbit,Math.exp(n*mf),i)}isPinch(e){return e.deltaMode===WheelEvent.DOM_DELTA_PIXEL&&!Number.isInteger(e.deltaY)}},gf=[`cameras`,`points`,`cells`,`things`,`blocks`],_f=.16,vf=1.2,yf=.22,bf=class{job;node;orbit={target:[0,0,0],azimuth:-2.2,elevation:.62,distance:8,ortho:!1};canvas=c(`canvas`,{class:`live-canvas`});marks=c(`div`,{class:`live-names`,"aria-hidden":`true`});steps=c(`ol`,{class:`live-steps`});scene=new or;camera=new fo(Ql*180/Math.PI,1,.05,500);layers=new Map;begun=new Map;asked=new Set;blocks=new Cu;controls;still=matchMedia(`(prefers-reduced-motion: reduce)`).matches;renderer=null;things=[];frame=0;last=0;touched=!1;constructor(e){this.job=e,this.node=c(`section`,{class:`live`,"aria-label":n.start.live},c(`div`,{class:`live-picture`},this.canvas,this.marks),this.steps),this.node.hidden=!0,this.controls=new hf(this.canvas,this),this.canvas.addEventListener(`pointerdown`,()=>this.touched=!0),this.scene.add(this.blocks.group),this.showSteps()}async refresh(){let e=await Xu(`api/start/jobs/${this.job}/layers`).catch(()=>[]);for(let t of e.filter(e=>!this.asked.has(e))){this.asked.add(t);let e=await fetch(`api/start/jobs/${this.job}/layers/${t}`).catch(()=>null);e?.ok&&this.take(t,await e.arrayBuffer())}}pointAt(){return null}dispose(){cancelAnimationFrame(this.frame),this.controls.dispose(),this.renderer?.dispose(),this.renderer=null}take(e,t){let n=e===`blocks`?this.takeBlocks(t):this.takePacket(e,ku.read(t,`W2ML`));n&&this.start()&&(e!==`blocks`&&this.scene.add(n),this.layers.set(e,n),this.begun.set(e,performance.now()),(e===`cells`||e===`blocks`)&&this.drop(`points`,`cameras`),e===`blocks`&&this.drop(`cells`,`things`),!this.touched&&e!==`things`&&e!==`blocks`&&this.fit(n),this.node.hidden=!1,this.showSteps())}takePacket(e,t){if(e===`things`)return this.things=t.told.things??[],Tf(this.things);if(e===`cameras`)return wf(t.array(`rays`).values);let n=t.array(`position`).values,r=t.array(`colour`).values;return n.length?e===`points`?xf(n,r):Sf(n,r,t.told.voxel_m):null}takeBlocks(e){return this.blocks.show(ju.read(e)),this.blocks.group.visible=!0,this.blocks.group}drop(...e){for(let t of e)this.layers.get(t)?.removeFromParent()}fit(e){let t=new xr().setFromObject(e);t.isEmpty()||(this.orbit=cu(this.orbit,t.min.toArray(),t.max.toArray(),this.camera.aspect))}start(){if(this.renderer)return!0;try{this.renderer=new Zl({canvas:this.canvas,antialias:!0,alpha:!0})}catch{return!1}this.renderer.outputColorSpace=ft,this.node.hidden=!1,this.last=performance.now();let e=t=>{this.frame=requestAnimationFrame(e),this.draw(t)};return this.frame=requestAnimationFrame(e),!0}draw(e){let{renderer:t}=this,n=this.canvas.getBoundingClientRect();if(!t||!n.width)return;let r=Math.min((e-this.last)/1e3,.1);this.last=e,!this.touched&&!this.still&&(this.orbit=au(this.orbit,_f*r,0)),t.setPixelRatio(Math.min(devicePixelRatio,2)),t.setSize(n.width,n.height,!1),this.camera.aspect=n.width/n.height,this.camera.updateProjectionMatrix(),this.camera.up.set(0,0,1),this.camera.position.set(...ru(this.orbit)),this.camera.lookAt(...this.orbit.target);for(let[t,n]of this.layers)this.raise(t,n,e);let{back:i}=nu(this.orbit);this.blocks.hide({classes:0,cuts:Nu(i)|16}),t.render(this.scene,this.camera),this.placeNames(n)}raise(e,t,n){let r=this.still?1:Math.min((n-this.begun.get(e))/1e3/vf,1);e!==`blocks`&&e!==`cameras`&&(t.scale.z=1-(1-r)**3+.001)}placeNames(e){let t=this.layers.has(`things`)&&!this.layers.has(`blocks`)?this.things:[];this.marks.childElementCount!==t.length&&u(this.marks,...t.map(e=>c(`span`,{},e.name)));for(let[n,r]of t.entries()){let[t,i,a]=r.center_m,o=new G(t,i,a+r.size_m[2]/2).project(this.camera),s=this.marks.children[n];s.style.transform=`translate(-50%, -100%) translate(${(o.x+1)/2*e.width}px, ${(1-o.y)/2*e.height}px)`}}showSteps(){let e=n.start.layers;u(this.steps,...gf.map(t=>c(`li`,{class:this.layers.has(t)?`is-done`:``},e[t])))}};function xf(e,t){let n=new ei;return n.setAttribute(`position`,new zr(e,3)),n.setAttribute(`color`,new zr(t,3,!0)),new da(n,new oa({size:.09,vertexColors:!0}))}function Sf(e,t,n){let r=e.length/3,i=new Bi(new _a(n,n,n),new Pa(Cf),r),a=new Y,o=new X;for(let n=0;n<r;n++)a.setPosition(e[3*n],e[3*n+1],e[3*n+2]),i.setMatrixAt(n,a),i.setColorAt(n,o.setRGB(t[3*n]/255,t[3*n+1]/255,t[3*n+2]/255));return i.frustumCulled=!1,i}var Cf={vertexShader:`
    varying vec3 shade;
    void main() {
      shade = instanceColor * (0.72 + 0.2 * abs(normal.z) + 0.08 * normal.x);
      gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position, 1.0);
    }`,fragmentShader:`
    varying vec3 shade;
    void main() {
      gl_FragColor = vec4(shade, 1.0);
    }`};function wf(e){let t=[];for(let n=0;n<e.length;n+=6){let r=new G().fromArray(e,n),i=new G().fromArray(e,n+3),a=new G().crossVectors(i,new G(0,0,1)).normalize(),o=new G().crossVectors(a,i),s=[[-1,-1],[1,-1],[1,1],[-1,1]].map(([e,t])=>r.clone().addScaledVector(i,yf).addScaledVector(a,e*.5*yf).addScaledVector(o,t*.38*yf));for(let[e,n]of s.entries())t.push(...r.toArray(),...n.toArray(),...n.toArray(),...s[(e+1)%4].toArray())}return Ef(t)}function Tf(e){let t=[];for(let{center_m:n,size_m:r,yaw_deg:i}of e){let e=new Sa(new _a(...r));e.rotateZ(i*Math.PI/180).translate(...n),t.push(...e.getAttribute(`position`).array)}return Ef(t)}function Ef(e){return new aa(new ei().setAttribute(`position`,new Hr(e,3)),new qi({color:new X().setRGB(.96,.6,.24)}))}function Df(e,t,r,i,a,o){let s=n.start,l=c(`h2`,{}),d=c(`div`,{class:`capture-body`}),f=c(`p`,{class:`trouble`,role:`alert`,hidden:!0});u(e,c(`div`,{class:`capture-head`},v(s.back,a,`button back`),l),f,d);let m=null,h=null,g=``,_=e=>{f.textContent=e,f.hidden=!e},y=(e,t,n)=>{let r=xd(t,()=>i.cancel(e));h?.live?.dispose();let a=n?new bf(e):null;h={id:e,line:r,live:a},u(d,r.node,a?.node,m&&uf(m,m.survey)),a?.refresh(),_(``),o()},b=async(e,n,r,i)=>{try{let{job:a}=await Zu(`api/start/captures/${t}/${e}`,n);y(a,r,i),await x(a)}catch(e){_(id(e))}},x=async e=>{let t=(await Xu(`api/jobs`)).find(t=>t.id===e);t&&C(t)},S=async()=>{try{await Zu(`api/start/open`,{id:t}),location.reload()}catch(e){_(id(e))}},C=e=>{h&&e.id===h.id&&(e.state===`running`?(h.line.show(e),e.stage!==g&&h.live?.refresh(),g=e.stage):(h.live?.dispose(),h=null,w(e.state===`failed`?e.note:e.state===`cancelled`?s.cancelled:``)))},w=async(e=``)=>{let n;try{n=await Xu(`api/start/captures/${t}`)}catch(e){_(id(e));return}l.textContent=n.title,m=n.survey?n:null,n.job||o(),n.job?(y(n.job,n.survey?s.making:s.looking,!!n.survey),await x(n.job)):n.complete&&!n.survey&&!e?await b(`look`,{},s.looking,!1):(T(n),_(n.complete?e:s.why.notWhole))},T=e=>{let{survey:n}=e,o=v(e.has_room?s.again:s.start,()=>m(),e.has_room?`button is-large`:`button is-main is-large`);o.dataset.do=`start`;let l=n&&ef(r,n,()=>f()),f=()=>{let e=n?.can_start?l?.why()??``:s.why.stop;p(o,e,o.textContent??``)},m=()=>{l&&b(`reconstruct`,l.choice(),s.making,!0)};u(d,e.has_room&&nf(t,e.title,i,()=>void S()),n&&lf(n),l?.node,c(`div`,{class:`row`},n&&o,Of(t,a,_)),n&&uf(e,n)),f()},E=i.on(C);return w(),()=>{E(),h?.live?.dispose()}}function Of(e,t,r){let i=n.start,a=!1,o=v(i.remove,()=>{a?$u(`api/start/captures/${e}`).then(t,e=>r(id(e))):(a=!0,o.textContent=i.removeConfirm)},`button is-danger is-quiet`);return o}var kf=25e3;async function Af(e){let t=[...e.items].map(e=>e.webkitGetAsEntry()).filter(e=>e!==null);if(!t.length)return[...e.files].map(e=>({path:e.name,file:e}));let n=[];for(let e of t)await Ff(e,n);return n}function jf(e){return[...e.files??[]].map(e=>({path:e.webkitRelativePath||e.name,file:e}))}var Mf=/\.(jpe?g|png|heic|heif|webp|tiff?)$/i;function Nf(e){let t=new Set(e.map(e=>e.path.split(`/`)[0]??``)),[r]=t;if(t.size===1&&r)return e.length===1?r.replace(/\.[^.]+$/,``):r;let i=e.filter(e=>Mf.test(e.path)).length;return n.start.untitled(i===e.length?`photos`:`files`,e.length)}function Pf(e){let t=Nf(e),r=n.start.countOf(e.length);return t.includes(r)||e.length===1?e.length===1?e[0].path:t:`${t}: ${r}`}async function Ff(e,t){if(t.length>kf)return;if(e.isFile){let n=await new Promise((t,n)=>{e.file(t,n)});t.push({path:e.fullPath.replace(/^\//,``),file:n});return}let n=e.createReader();for(;;){let e=await new Promise((e,t)=>{n.readEntries(e,t)});if(!e.length)return;for(let n of e)await Ff(n,t)}}var If=2e3;function Lf(e,t){let r=c(`section`,{class:`phone-panel`,"aria-label":n.start.phone.title}),i=``,a=JSON.stringify(e.captures),o=e=>{let o=JSON.stringify(e.captures);o!==a&&t(),a=o;let c=e.link?n.start.phone.left(bd(e.left_s)):``,l=JSON.stringify([e.code,e.phones,c]);l!==i&&u(r,...Rf(e,c,s)),i=l},s=()=>{Zu(`api/start/phone`).then(o,e=>u(r,c(`p`,{class:`trouble`},id(e))))},l=()=>{r.isConnected&&(Xu(`api/start/phone`).then(o,()=>void 0),setTimeout(l,If))};return o(e),setTimeout(l,If),r}function Rf(e,t,r){let i=n.start.phone,a=c(`strong`,{},i.title),o=v(i.renew,r,e.link?`button is-quiet`:`button is-main`);if(o.dataset.do=`phone-code`,!e.link){let t=e.phones?i.connected(e.phones):i.old;return[c(`div`,{class:`phone-mark`},Cd(e.phones?`check`:`scan`)),a,c(`p`,{class:`note`},t),o]}let s=c(`img`,{class:`phone-code`,src:e.code,alt:i.alt,width:164,height:164}),l=c(`p`,{class:`phone-link`},e.link);return[s,a,c(`p`,{class:`note`},i.lead),l,c(`div`,{class:`row`},c(`span`,{class:`note`},t),o)]}function zf(e,t){let r=n.start,i=[...e.captures.map(e=>Hf(e,t)),...e.recent.map(({id:e,name:n,folder:i,has_picture:a})=>Uf(n,i,r.states.here,a?Vf(e):null,()=>t.open(e)))],a=e.demos.map(e=>v(r.kinds[e]??e,()=>t.demo(e)));for(let[t,n]of e.demos.entries())a[t].dataset.demo=n;return c(`div`,{class:`stack`},i.length>0&&c(`h2`,{},r.rooms),i.length>0&&c(`ul`,{class:`room-list`},...i),Bf(t),c(`h2`,{},r.demo),c(`p`,{class:`note`},r.demoLead),c(`div`,{class:`demo-kinds`},...a))}function Bf(e){let t=n.start,r=c(`button`,{type:`button`,class:`example-card`,data:{do:`example`}},c(`img`,{src:Vf(`example`),alt:``,width:720,height:540}),c(`span`,{class:`example-words`},c(`strong`,{},t.example),c(`span`,{class:`note`},t.exampleLead)));return r.addEventListener(`click`,()=>e.open(`example`)),r}function Vf(e){return`api/start/rooms/${e}/picture`}function Hf(e,t){let{states:r}=n.start,i=e.job?r.working:e.has_room?r.room:e.complete?r.ready:r.partly,a=e.elsewhere||n.start.megabytes(e.bytes/2**20),o=e.has_room?Vf(e.id):null;return Uf(e.title,a,i,o,()=>t.look(e.id))}function Uf(e,t,n,r,i){let a=c(`button`,{type:`button`,class:`room-row`},c(`span`,{class:`room-picture`},r?c(`img`,{src:r,alt:``,loading:`lazy`}):Cd(`cube`)),c(`span`,{class:`room-words`},c(`strong`,{},e),c(`span`,{class:`note`},t)),c(`span`,{class:`room-state`},n));return a.addEventListener(`click`,i),c(`li`,{},a)}var Wf=500,Gf=3e3;async function Kf(e,t,n,r,i){let a=t.map(({path:e,file:t})=>({path:e,size:t.size})),o=await Zu(n.base,{title:e,files:a}),s=qf(t,o),c=o.files.reduce((e,t)=>e+t.size,0),l=0;for(let e=0;e<o.files.length;e++){let t=s[e];await Jf(o.id,e,t,n,e=>r(l+e,c),i),l+=t.size}return o.id}function qf(e,t){let n=[...e];return t.files.map(({path:e,size:t})=>{let r=n.findIndex(n=>n.file.size===t&&(n.path===e||n.path.endsWith(`/${e}`))),[i]=n.splice(Math.max(r,0),1);if(!i)throw Error(e);return i.file})}async function Jf(e,t,n,r,i,a){let o=`${r.base}/${e}`,s=0,c=0,l=!1;do{a.throwIfAborted();try{l&&(s=(await Xu(o)).held[t]??0),l=!0,(s<n.size||!n.size)&&(s=await Yf(`${o}/files/${t}`,n,s,r,a)),l=!1,c=0,r.lost?.(!1)}catch(e){if(!Xf(e)||++c>r.tries)throw e;r.lost?.(!0),await new Promise(e=>setTimeout(e,Math.min(Wf*c,Gf)))}i(s)}while(s<n.size)}async function Yf(e,t,n,r,i){let a=t.slice(n,n+r.chunkBytes),o=new AbortController,s=()=>o.abort(),c=r.stallMs?setTimeout(s,r.stallMs):void 0;i.addEventListener(`abort`,s);try{return(await Qu(`${e}?at=${n}`,a,{signal:o.signal})).held}finally{clearTimeout(c),i.removeEventListener(`abort`,s)}}function Xf(e){return e instanceof ed||e instanceof td&&e.status===409}function Zf(){O((e,t)=>new Qf(e,t))}var Qf=class{main=c(`div`,{class:`start-main`});aside=c(`aside`,{class:`start-rooms`,"aria-label":n.start.rooms});trouble=c(`p`,{class:`trouble`,role:`alert`,hidden:!0});jobs;told=null;leave=()=>void 0;constructor(e,t){this.jobs={on:e=>t.connection.onJob(e),cancel:e=>t.connection.cancel(e)};let r=c(`header`,{class:`start-head`},c(`h1`,{},n.start.title),c(`p`,{},n.start.lead));e.append(c(`div`,{class:`start-sheet`},r,this.trouble,c(`div`,{class:`start-columns`},this.main,this.aside))),this.takeDrops(e),this.refresh(!0)}async refresh(e=!1){try{this.told=await Xu(`api/start`)}catch(e){this.complain(id(e));return}u(this.aside,zf(this.told,{look:e=>this.show(e),open:e=>void this.open(e),demo:e=>void this.demo(e)})),e&&this.told.wanted?this.show(this.told.wanted):e&&this.showDrop()}complain(e){this.trouble.textContent=e,this.trouble.hidden=!e}showDrop(){this.leave();let e=n.start,t=c(`input`,{type:`file`,multiple:!0,hidden:!0,data:{pick:`files`}}),r=c(`input`,{type:`file`,webkitdirectory:!0,hidden:!0,data:{pick:`folder`}});for(let e of[t,r])e.addEventListener(`change`,()=>void this.take(jf(e)));let i=e.megabytes((this.told?.most_bytes??0)/2**20),a=this.told?.phone,o=c(`div`,{class:`drop`},Cd(`export`),c(`strong`,{},e.drop),c(`p`,{},e.dropHint),c(`div`,{class:`row`},v(e.chooseFiles,()=>t.click(),`button is-main`),v(e.chooseFolder,()=>r.click())),c(`p`,{class:`note`},e.limit(i)),t,r),s=a?e.kindsOfCapture:[...e.kindsOfCapture,[`scan`,...e.phone.off]];u(this.main,c(`div`,{class:`start-ways`},o,a&&Lf(a,()=>void this.refresh())),c(`h2`,{},e.works),c(`ul`,{class:`works`},...s.map(([e,t,n])=>$f(e,t,n))))}show(e){if(!this.told)return;this.leave(),this.complain(``);let t=()=>{this.showDrop(),this.refresh()};this.leave=Df(this.main,e,this.told,this.jobs,t,()=>void this.refresh())}async take(e){if(this.complain(``),!e.length||!this.told){this.complain(n.start.nothingDropped);return}this.leave();let t=new AbortController,r=xd(n.start.sendingTitle,()=>t.abort());u(this.main,c(`h2`,{},Pf(e)),r.node);let i=e=>n.start.megabytes(e/2**20),a=(e,t)=>{r.show({stage:``,done:0,total:0,left_s:null,note:``,share:t?e/t:0}),r.say(n.start.sending(i(e),i(t)))},o={base:`api/start/captures`,chunkBytes:this.told.chunk_bytes,tries:6};try{let n=await Kf(Nf(e),e,o,a,t.signal);await this.refresh(),this.show(n)}catch(e){this.showDrop(),this.complain(t.signal.aborted?n.start.cancelled:id(e))}}finish(e,t){this.leave(),this.leave=()=>void 0;let r=v(n.start.back,()=>this.showDrop(),`button back`),i=nf(e,t,this.jobs,()=>void this.open(e));u(this.main,c(`div`,{class:`capture-head`},r,c(`h2`,{},t)),c(`div`,{class:`capture-body`},i)),this.refresh()}async open(e){try{await Zu(`api/start/open`,{id:e}),location.reload()}catch(e){this.complain(id(e))}}async demo(e){this.complain(``);try{let{job:t}=await Zu(`api/start/demo`,{kind:e});this.leave();let r=xd(n.start.kinds[e]??e,()=>this.jobs.cancel(t)),i=new bf(t);u(this.main,r.node,i.node);let a=``,o=this.jobs.on(e=>{e.id===t&&(e.state===`running`?(r.show(e),e.stage!==a&&i.refresh(),a=e.stage):e.state===`done`?this.finish(`recent-0`,e.title):(this.showDrop(),this.complain(e.state===`failed`?e.note:n.start.cancelled)))});this.leave=()=>{o(),i.dispose()}}catch(e){this.complain(id(e))}}takeDrops(e){let t=0,n=t=>void e.classList.toggle(`is-over`,t),r=e=>e.dataTransfer?.types.includes(`Files`)??!1;e.addEventListener(`dragenter`,e=>{r(e)&&(e.preventDefault(),t+=1,n(!0))}),e.addEventListener(`dragover`,e=>r(e)&&e.preventDefault()),e.addEventListener(`dragleave`,()=>{t=Math.max(t-1,0),n(t>0)}),e.addEventListener(`drop`,e=>{e.preventDefault(),t=0,n(!1),e.dataTransfer&&Af(e.dataTransfer).then(e=>this.take(e),e=>this.complain(id(e)))})}};function $f(e,t,n){return c(`li`,{},Cd(e),c(`div`,{},c(`strong`,{},t),c(`span`,{class:`note`},n)))}var ep={scene:null,labels:new Uint8Array,instance:new Uint16Array,confidence:new Uint8Array,touched:{rev:0,runs:null},objects:new Map,clashes:new Map,mode:`inspect`,tool:`navigate`,options:{classId:10,shape:`sphere`,size:3,depth:0,fills:`empty`,surfaceOnly:!0,snap:!1},view:{hidden:new Set([1]),solo:null,locked:new Set,voxelSize:1,opacity:1,centerSize:.12,edges:!0,colourBy:`class`,slice:null,section:null},selectedObjects:new Set,selectedCells:new Set,theme:`dark`,status:``,online:!1},tp=class{state=ep;listeners=[];get(){return this.state}set(e){this.state={...this.state,...e};let t=new Set(Object.keys(e));for(let{keys:e,call:n}of this.listeners)e.some(e=>t.has(e))&&n(this.state,t)}setView(e){this.set({view:{...this.state.view,...e}})}setOptions(e){this.set({options:{...this.state.options,...e}})}watch(e,t){let n={keys:e,call:t};return this.listeners.push(n),t(this.state,new Set(e)),()=>{this.listeners=this.listeners.filter(e=>e!==n)}}};function np(e,t){let{scene:n,labels:r,instance:i,confidence:a,objects:o,selectedObjects:s}=e.get();if(!n)return;let c=t.cells??[];rp(c,r,i,a);let l=new Map(o);for(let e of t.gone)l.delete(e);for(let e of t.objects)l.set(e.id,e);let{rev:u,counts:d,undo:f,redo:p,saved:m}=t;e.set({scene:{...n,rev:u,counts:d,undo:f,redo:p,saved:m,objects:[...l.values()]},labels:r,instance:i,confidence:a,touched:{rev:u,runs:c},objects:l,selectedObjects:new Set([...s].filter(e=>l.has(e)))})}function rp(e,t,n,r){for(let[i,a,o,s,c]of e)t.fill(o,i,i+a),n.fill(s,i,i+a),r.fill(c,i,i+a)}var ip=`cells`,ap=class extends Error{},op=[250,500,1e3,2e3,5e3],sp=class{store;socket=null;waiting=new Map;seq=0;attempt=0;greeted=!1;loading=!1;early=[];jobListeners=new Set;changeListeners=new Set;lastActive=0;constructor(e){this.store=e}async open(){this.connect(),await this.load()}do(e){return this.send(t=>({type:`do`,seq:t,command:e}))}undo(){return this.send(e=>({type:`undo`,seq:e}))}redo(){return this.send(e=>({type:`redo`,seq:e}))}save(){return this.send(e=>({type:`save`,seq:e}))}preview(e){return cp(`api/preview`,e)}ask(e,t={}){return cp(`api/ask/${e}`,t)}cancel(e){this.say({type:`cancel`,job:e})}active(){let e=Date.now();e-this.lastActive<1e3||(this.lastActive=e,this.say({type:`active`}))}onJob(e){return this.jobListeners.add(e),()=>this.jobListeners.delete(e)}onChange(e){return this.changeListeners.add(e),()=>this.changeListeners.delete(e)}connect(){let e=new URL(`api/live`,document.baseURI);e.protocol=e.protocol===`https:`?`wss:`:`ws:`;let t=new WebSocket(e);this.socket=t,this.greeted=!1,t.onmessage=e=>this.hear(JSON.parse(e.data)),t.onopen=()=>{this.attempt=0,this.store.set({online:!0})},t.onclose=()=>this.lost()}lost(){this.store.set({online:!1}),this.giveUp(n.error.lost);let e=op[Math.min(this.attempt,op.length-1)]??5e3;this.attempt+=1,setTimeout(()=>this.connect(),e)}giveUp(e){for(let t of this.waiting.values())t.reject(Error(e));this.waiting.clear()}hear(e){e.type===`hello`?this.greet(e):e.type===`change`?this.take(e):e.type===`saved`?this.saved():e.type===`job`?this.jobListeners.forEach(t=>t(e)):this.answer(e)}greet(e){if(e.protocol!==1){this.store.set({status:n.error.protocol});return}this.greeted&&this.giveUp(n.error.behind),this.greeted=!0;let{document:t,rev:r}=this.store.get().scene??{document:0,rev:0};(t!==e.document||t&&r!==e.rev)&&this.reload()}reload(){this.load().catch(e=>{e instanceof ap?this.store.set({scene:null}):this.store.set({status:e instanceof Error?e.message:n.error.load})})}take(e){if(this.loading){this.early.push(e);return}let t=this.store.get().scene;!t||e.rev<=t.rev||(e.rev!==t.rev+1||e.cells===null?this.reload():np(this.store,e),this.changeListeners.forEach(t=>t(e)))}saved(){let e=this.store.get().scene;e&&this.store.set({scene:{...e,saved:!0}})}answer(e){let t=this.waiting.get(e.seq);this.waiting.delete(e.seq),e.type===`done`?t?.resolve(e.rev):t?.reject(Error(e.error))}send(e){let t=++this.seq;return new Promise((r,i)=>{this.socket?.readyState===WebSocket.OPEN?(this.waiting.set(t,{resolve:r,reject:i}),this.say(e(t))):i(Error(n.error.offline))})}say(e){this.socket?.readyState===WebSocket.OPEN&&this.socket.send(JSON.stringify(e))}async load(){if(!this.loading){this.loading=!0;try{for(let e=0;e<5&&!await this.loadOnce();e++);}finally{this.loading=!1;for(let e of this.early.splice(0))this.take(e)}}}async loadOnce(){let e=await fetch(`api/scene`);if(e.status===404)throw new ap;if(!e.ok)throw Error(await lp(e));let t=await e.json(),[n,r,i]=await Promise.all([sd(`labels`),sd(`instance`),sd(`confidence`)]);return![n,r,i].some(e=>e.rev!==t.rev)&&(this.store.set({scene:t,labels:n.cells,instance:r.cells,confidence:i.cells,touched:{rev:t.rev,runs:null},objects:new Map(t.objects.map(e=>[e.id,e]))}),!0)}};async function cp(e,t){let r;try{r=await fetch(e,{method:`POST`,headers:{"Content-Type":`application/json`},body:JSON.stringify(t)})}catch{throw Error(n.error.offline)}if(!r.ok)throw Error(await lp(r));return await r.json()}async function lp(e){try{return(await e.json()).error}catch{return`${e.status} ${e.statusText}`}}var up=Object.keys(n.groups),dp=[`voxels`],fp=[`objects`],pp=[`objects`,`build`],mp=[`voxels`,`objects`],hp=[`inspect`,`voxels`,`objects`],$=[`inspect`,`voxels`,`objects`,`build`],gp=[[`help`,`page`,[`?`,`F1`]],[`palette`,`page`,[`Ctrl+K`]],[`cancel`,`page`,[`Escape`]],[`save`,`page`,[`Ctrl+S`]],[`export`,`page`,[`Ctrl+E`]],[`theme`,`page`,[]],[`start`,`page`,[]],[`undo`,`edit`,[`Ctrl+Z`]],[`redo`,`edit`,[`Ctrl+Shift+Z`,`Ctrl+Y`]],[`delete`,`edit`,[`Delete`,`Backspace`],mp],[`mode.inspect`,`modes`,[`Shift+1`]],[`mode.voxels`,`modes`,[`Shift+2`]],[`mode.objects`,`modes`,[`Shift+3`]],[`mode.build`,`modes`,[`Shift+4`]],[`mode.walk`,`modes`,[`Shift+5`,`V`]],[`view.focus`,`view`,[`F`],$],[`view.reset`,`view`,[`Shift+F`],$],[`view.top`,`view`,[`Numpad7`],$],[`view.front`,`view`,[`Numpad1`],$],[`view.side`,`view`,[`Numpad3`],$],[`view.ortho`,`view`,[`Numpad5`],$],[`camera.left`,`view`,[`Ctrl+ArrowLeft`],$],[`camera.right`,`view`,[`Ctrl+ArrowRight`],$],[`camera.up`,`view`,[`Ctrl+ArrowUp`],$],[`camera.down`,`view`,[`Ctrl+ArrowDown`],$],[`camera.panLeft`,`view`,[`Shift+ArrowLeft`],$],[`camera.panRight`,`view`,[`Shift+ArrowRight`],$],[`camera.panUp`,`view`,[`Shift+ArrowUp`],$],[`camera.panDown`,`view`,[`Shift+ArrowDown`],$],[`camera.closer`,`view`,[`Shift+PageUp`],$],[`camera.away`,`view`,[`Shift+PageDown`],$],[`view.hide`,`view`,[`\\`],$],[`view.unhide`,`view`,[`Shift+\\`],$],[`view.solo`,`view`,[`O`],$],[`view.edges`,`view`,[`E`],hp],[`slice.up`,`view`,[`PageUp`],$],[`slice.down`,`view`,[`PageDown`],$],[`photo.way`,`photos`,[`P`],$],[`photo.leave`,`photos`,[]],[`doubtful.next`,`view`,[`.`],$],[`doubtful.previous`,`view`,[`,`],$],[`tool.navigate`,`tools`,[`Q`],$],[`tool.measure`,`tools`,[`J`],$],[`tool.eyedropper`,`tools`,[`I`],mp],[`tool.brush`,`tools`,[`B`],dp],[`tool.erase`,`tools`,[`Shift+B`],dp],[`tool.box`,`tools`,[`X`],dp],[`tool.lasso`,`tools`,[`L`],dp],[`tool.flood`,`tools`,[`K`],dp],[`brush.smaller`,`tools`,[`[`],dp],[`brush.larger`,`tools`,[`]`],dp],[`brush.shape`,`tools`,[`Shift+X`],dp],[`surface`,`tools`,[`U`],dp],[`cursor.right`,`voxels`,[`ArrowRight`],dp],[`cursor.left`,`voxels`,[`ArrowLeft`],dp],[`cursor.away`,`voxels`,[`ArrowUp`],dp],[`cursor.near`,`voxels`,[`ArrowDown`],dp],[`cursor.up`,`voxels`,[`Alt+ArrowUp`],dp],[`cursor.down`,`voxels`,[`Alt+ArrowDown`],dp],[`cursor.paint`,`voxels`,[`Space`],dp],[`cursor.erase`,`voxels`,[`Shift+Space`],dp],[`cells.relabel`,`voxels`,[`Enter`],dp],[`cells.fillBox`,`voxels`,[`Shift+Enter`],dp],[`cells.smooth`,`voxels`,[`Shift+S`],dp],[`cells.copy`,`voxels`,[`Ctrl+C`],dp],[`cells.paste`,`voxels`,[`Ctrl+V`],dp],[`cells.component`,`voxels`,[`Shift+Delete`],dp],[`holes.fill`,`voxels`,[`H`],dp],[`floaters.find`,`voxels`,[`Shift+H`],dp],[`select.all`,`selection`,[`Ctrl+A`],mp],[`select.none`,`selection`,[`Ctrl+Shift+A`],mp],[`select.invert`,`selection`,[`Ctrl+I`],mp],[`select.undo`,`selection`,[`Alt+Z`],mp],[`select.redo`,`selection`,[`Alt+Shift+Z`],mp],[`tool.move`,`objects`,[`G`],fp],[`tool.add`,`objects`,[`N`],fp],[`object.turn`,`objects`,[`R`],pp],[`object.turnBack`,`objects`,[`Shift+R`],pp],[`object.template`,`objects`,[`T`],pp],[`object.templateBack`,`objects`,[`Shift+T`],pp],[`object.split`,`objects`,[`S`],fp],[`object.merge`,`objects`,[`M`],fp],[`object.duplicate`,`objects`,[`D`],fp],[`object.floor`,`objects`,[`C`],fp],[`object.wall`,`objects`,[`Shift+C`],fp],[`object.relabel`,`objects`,[`Enter`],fp],[`object.rematch`,`objects`,[`Shift+M`],fp],[`walk.ask`,`walk`,[`G`],[`inspect`,`build`,`walk`]],[`object.next`,`objects`,[`ArrowRight`],fp],[`object.previous`,`objects`,[`ArrowLeft`],fp]],_p=[`1`,`2`,`3`,`4`,`5`,`6`,`7`,`8`,`9`,`0`,`-`,`=`].map((e,t)=>({id:`class.${(t+1)%12}`,keys:[e],group:`classes`,title:n.pickClass((t+1)%12),modes:mp})),vp=n.gestures.map(([e,t,n,r])=>({id:e,keys:[n],group:t,title:r,gesture:!0})),yp=[...gp.map(([e,t,r,i])=>({id:e,keys:r,group:t,title:n.action[e],modes:i})),..._p,...vp];function bp(e){return yp.find(t=>t.id===e)}function xp(e,t){let n=Sp(e);return yp.find(e=>!e.gesture&&(!e.modes||e.modes.includes(t))&&e.keys.some(e=>e===n))}function Sp(e){let t=wp(e),n=e.shiftKey&&t!==`?`;return[...[(e.ctrlKey||e.metaKey)&&`Ctrl`,e.altKey&&`Alt`,n&&`Shift`].filter(Boolean),t].join(`+`)}var Cp={Backslash:`\\`,BracketLeft:`[`,BracketRight:`]`,Minus:`-`,Equal:`=`};function wp({key:e,code:t}){return e===` `?`Space`:t.startsWith(`Digit`)?t.slice(5):t.startsWith(`Numpad`)&&/\d$/.test(t)?t:e===`?`||e.length>1?e:Cp[t]??e.toUpperCase()}var Tp=class{refuse;actions=new Map;buttons=new Set;due=!1;constructor(e,t){this.refuse=t,e.watch([`scene`,`objects`,`selectedObjects`,`selectedCells`,`mode`,`tool`,`view`,`options`,`online`,`theme`],()=>this.refresh())}on(e,t){this.actions.set(e,typeof t==`function`?{run:t}:t)}has(e){return this.actions.has(e)}why(e){let t=this.actions.get(e);return t?t.why?.()??``:n.why.notHere}active(e){return this.actions.get(e)?.active?.()??!1}run(e){let t=this.why(e);t?this.refuse(t):this.actions.get(e)?.run()}list(){return yp.filter(e=>this.has(e.id)).map(e=>({binding:e,why:this.why(e.id)}))}button(e,t={}){let n=t.label??(t.icon?``:Ep(e)),r=c(`button`,{type:`button`,class:t.class??(n?`button`:`button icon-only`),data:{action:e},"aria-label":n?void 0:Ep(e),on:{click:()=>this.run(e)}},t.icon&&Cd(t.icon),n&&c(`span`,{},n));return this.buttons.add({node:new WeakRef(r),id:e}),this.show(r,e),r}refresh(){this.due||(this.due=!0,requestAnimationFrame(()=>{this.due=!1;for(let e of this.buttons){let t=e.node.deref();t?this.show(t,e.id):this.buttons.delete(e)}}))}show(e,t){let n=bp(t)?.keys[0],r=this.actions.get(t),i=r?.title?.()??Ep(t);p(e,this.why(t),n?`${i} (${n})`:i),r?.title&&e.setAttribute(`aria-label`,i),r?.active&&e.setAttribute(`aria-pressed`,String(this.active(t)))}};function Ep(e){return bp(e)?.title??e}function Dp(e){let{scene:t,online:r}=e.get();return t?r?t.read_only&&n.why.readOnly(t.read_only):n.why.offline:n.why.noScene}function Op(e){let t=e.ctrlKey||e.metaKey;return e.shiftKey?t?`intersect`:`add`:t?`subtract`:`replace`}function kp(e,t,n){let r=new Set(t);if(n===`replace`)return r;if(n===`add`)return new Set([...e,...r]);let i=n===`intersect`;return new Set([...e].filter(e=>r.has(e)===i))}var Ap=class{store;past=[];future=[];constructor(e){this.store=e}cells(e,t=`replace`){let{selectedCells:n,selectedObjects:r}=this.store.get();this.change({cells:kp(n,e,t),objects:r})}objects(e,t=`replace`){let{selectedCells:n,selectedObjects:r}=this.store.get();this.change({cells:n,objects:kp(r,e,t)})}clear(){this.change({cells:new Set,objects:new Set})}get canUndo(){return this.past.length>0}get canRedo(){return this.future.length>0}undo(){let e=this.past.pop();e&&(this.future.push(this.now()),this.put(e))}redo(){let e=this.future.pop();e&&(this.past.push(this.now()),this.put(e))}now(){let{selectedCells:e,selectedObjects:t}=this.store.get();return{cells:e,objects:t}}change(e){let t=this.now();jp(t.cells,e.cells)&&jp(t.objects,e.objects)||(this.past=[...this.past.slice(-99),t],this.future=[],this.put(e))}put({cells:e,objects:t}){this.store.set({selectedCells:e,selectedObjects:t})}};function jp(e,t){return e.size===t.size&&[...e].every(e=>t.has(e))}var Mp=5;function Np(e){return e>=Mp?``:n.why.notAnObject}function Pp(e){let{app:t}=e;return{id:`add`,cursor:`copy`,hover:t=>{t?e.marks.circle(`add`,[t.x,t.y],9):e.marks.clear(`add`)},press:e=>{let r=t.view.pointAt(e.x,e.y);return{move:()=>void 0,end:()=>{let{classId:e}=t.store.get().options,i=Np(e)||(r?``:n.why.noPlace);i||!r?t.toast(i,`error`):t.do({op:`add_object`,class_id:e,at_m:r})},cancel:()=>void 0}},stop:()=>e.marks.clear(`add`)}}var Fp=3;function Ip({app:e}){let{depth:t,surfaceOnly:n}=e.store.get().options;return n?`surface`:t||`through`}function Lp(e){return{id:`box`,cursor:`crosshair`,press:t=>Rp(e,t)}}function Rp(e,t){let{view:n}=e.app,r=()=>e.marks.clear(`box`);return{move:n=>e.marks.polygon(`box`,zp(t,n)),end:i=>{r();let[a,o]=[Math.min(t.x,i.x),Math.max(t.x,i.x)],[s,c]=[Math.min(t.y,i.y),Math.max(t.y,i.y)];e.selection.cells(n.cellsInRect(a,s,o,c,Ip(e)),Op(i))},cancel:r}}function zp(e,t){return[[e.x,e.y],[t.x,e.y],[t.x,t.y],[e.x,t.y]]}function Bp(e){return{id:`lasso`,cursor:`crosshair`,press:t=>Vp(e,t)}}function Vp(e,t){let n=[[t.x,t.y]],r=()=>e.marks.clear(`lasso`);return{move:t=>{let[r,i]=n[n.length-1]??[0,0];Math.hypot(t.x-r,t.y-i)<Fp||(n.push([t.x,t.y]),e.marks.polygon(`lasso`,n))},end:t=>{r(),n.length<3||e.selection.cells(e.app.view.lasso(n,Ip(e)),Op(t))},cancel:r}}function Hp(e,t){return(e[0]*t[1]+e[1])*t[2]+e[2]}function Up(e,t){let n=e%t[2],r=(e-n)/t[2],i=r%t[1];return[(r-i)/t[1],i,n]}function Wp(e,t){return e.every((e,n)=>e>=0&&e<t[n])}function Gp(e){let t=Int32Array.from(e).sort(),n=[],r=null;for(let e of t)r&&e<r[0]+r[1]||(r&&e===r[0]+r[1]?r[1]+=1:n.push(r=[e,1]));return n}function Kp(e){let t=[];for(let[n=0,r=0]of e)for(let e=0;e<r;e++)t.push(n+e);return t}function qp(e,t,n,r){let i=n===`single`?1:Math.max(1,Math.round(r)),a=e.map(e=>e-Math.floor((i-1)/2)),o=a.map(e=>e+(i-1)/2),s=(i/2)**2,c=[];for(let e=a[0];e<a[0]+i;e++)for(let r=a[1];r<a[1]+i;r++)for(let l=a[2];l<a[2]+i;l++){let i=(e-o[0])**2+(r-o[1])**2+(l-o[2])**2;n===`sphere`&&i>s||Wp([e,r,l],t)&&c.push(Hp([e,r,l],t))}return c}function Jp(e,t){let n=Math.max(...e.map((e,n)=>Math.abs(t[n]-e)),1);return Array.from({length:n+1},(r,i)=>{let a=i/n;return e.map((e,n)=>Math.round(e+(t[n]-e)*a))})}function Yp(e,t,n,r=1/0){let i=t[e],a=new Uint8Array(t.length),o=[e];a[e]=1;let s=[n[1]*n[2],n[2],1];for(let e=0;e<o.length&&o.length<r;e++){let r=o[e]??0,c=Up(r,n);for(let e=0;e<3;e++)for(let l of[-1,1]){let u=(c[e]??0)+l;if(u<0||u>=(n[e]??0))continue;let d=r+l*(s[e]??0);a[d]||t[d]!==i||(a[d]=1,o.push(d))}}return o}function Xp(e,t){let n=[1/0,1/0,1/0],r=[-1,-1,-1];for(let i of e)Up(i,t).forEach((e,t)=>{n[t]=Math.min(n[t],e),r[t]=Math.max(r[t],e)});return r[0]<0?null:{low:n,high:r}}var Zp=`#ff5252`,Qp=[[1,0,0],[0,1,0],[0,0,1],[-1,0,0],[0,-1,0],[0,0,-1]];function $p(e,t){let n=t===`erase`,{view:r}=e.app;return{id:t,cursor:`crosshair`,press:t=>em(e,n,t),hover:t=>{let i=t&&tm(e,n,t),a=i?nm(e,n,i):[];r.setOverlay(`brush`,a.length?Gp(a):null,rm(e,n))},stop:()=>r.setOverlay(`brush`,null,Zp)}}function em(e,t,n){let{app:r}=e,i=new Set,a=null,o=n=>{let o=tm(e,t,n);if(!o)a=null;else{for(let n of Jp(a??o,o))for(let r of nm(e,t,n))i.add(r);a=o,r.view.setOverlay(`brush`,Gp(i),rm(e,t))}};return o(n),{move:o,end:()=>{if(r.view.setOverlay(`brush`,null,Zp),!i.size)return;let{options:e,view:n}=r.store.get(),a=t?0:e.classId,o=t||!a?`erase`:e.fills===`occupied`?`relabel`:`paint`;r.do({op:`set_cells`,cells:Gp(i),class_id:a,verb:o,locked:[...n.locked]})},cancel:()=>r.view.setOverlay(`brush`,null,Zp)}}function tm({app:e},t,n){let r=e.view.pick(n.x,n.y),{scene:i,options:a}=e.store.get();if(!r||!i)return null;if(t||a.fills===`occupied`)return r.cell;let o=Qp[r.face]??[0,0,0],s=r.cell.map((e,t)=>e+o[t]);return Wp(s,i.shape)?s:r.cell}function nm({app:e},t,n){let{scene:r,labels:i,options:a,view:o}=e.store.get();if(!r)return[];let s=t?`occupied`:a.fills,c=e=>{let n=i[e]??255,r=n!==0&&n!==255;return o.locked.has(n)||t&&o.hidden.has(n)?!1:s===`all`||s===`occupied`===r},l=qp(n,r.shape,a.shape,a.size).filter(c);return l.length||!t?l:[Hp(n,r.shape)].filter(c)}function rm({app:e},t){let{scene:n,options:r}=e.store.get(),i=n?.classes[r.classId]?.colour;return t||!r.classId||!i?Zp:`rgb(${i.join(`,`)})`}var im=`#ff2bd6`,am=.85;function om(e,t){return Math.abs(e)>=Math.abs(t)?[Math.sign(e)||1,0,0]:[0,Math.sign(t),0]}function sm(e){let t=om(-Math.sin(e),Math.cos(e));return{right:t,away:[-t[1]||0,t[0],0]}}function cm(e){let{actions:t,store:r,view:i}=e,a=null,o=()=>{let{scene:e,mode:t,labels:o}=r.get(),s=a&&e&&t===`voxels`&&Wp(a,e.shape);if(i.setOverlay(`cursor`,s?Gp([Hp(a,e.shape)]):null,im,am),!s)return;let c=o[Hp(a,e.shape)]??255;r.set({status:n.cursor(a.join(`, `),n.classes[c]??n.status.unseen)})},s=t=>{let{scene:n}=r.get();if(!n)return;let s=a&&Wp(a,n.shape)?a:null,c=t(sm(i.orbit.azimuth)),l=s?s.map((e,t)=>e+c[t]):lm(e);Wp(l,n.shape)&&(a=l),o()},c=async t=>{let{scene:n,view:i}=r.get();if(!n||!a)return;let s=Gp([Hp(a,n.shape)]),c=t?`paint`:`erase`;await e.do({op:`set_cells`,cells:s,class_id:t,verb:c,locked:[...i.locked]}),o()},l=e=>e.map(e=>-e),u=()=>r.get().scene?``:n.why.noScene,d=(e,n)=>t.on(e,{run:()=>s(n),why:u});d(`cursor.right`,({right:e})=>e),d(`cursor.left`,({right:e})=>l(e)),d(`cursor.away`,({away:e})=>e),d(`cursor.near`,({away:e})=>l(e)),d(`cursor.up`,()=>[0,0,1]),d(`cursor.down`,()=>[0,0,-1]);let f=()=>Dp(r)||(a?``:n.why.noCursor);t.on(`cursor.paint`,{run:()=>void c(r.get().options.classId),why:f}),t.on(`cursor.erase`,{run:()=>void c(0),why:f}),r.watch([`mode`],o)}function lm({store:e,view:t,canvas:n}){let{scene:r,selectedCells:i}=e.get(),a=r?.shape??[1,1,1],[o]=i;if(o!==void 0)return Up(o,a);let s=t.pick(n.clientWidth/2,n.clientHeight/2);return s?s.cell:a.map(e=>Math.floor(e/2))}function um(e){let{store:t,view:n}=e.app,r=`navigate`;return t.watch([`tool`],({tool:e})=>{e!==`eyedropper`&&(r=e)}),{id:`eyedropper`,cursor:`copy`,press:e=>{let i=n.pick(e.x,e.y);return{move:()=>void 0,end:()=>{let e=i?t.get().labels[i.flat]:void 0;e!==void 0&&e<12&&t.setOptions({classId:e}),t.set({tool:r})},cancel:()=>void 0}}}}var dm=`#ffffff`,fm=2e4;function pm(e){let{app:t}=e,n=()=>t.view.setOverlay(`flood`,null,dm),r=-1;return{id:`flood`,cursor:`crosshair`,press:n=>{let r=t.view.pick(n.x,n.y),{scene:i,labels:a}=t.store.get(),o=r&&i?Yp(r.flat,a,i.shape):[];return{move:()=>void 0,end:t=>{(r||Op(t)===`replace`)&&e.selection.cells(o,Op(t))},cancel:()=>void 0}},hover:e=>{let i=e&&t.view.pick(e.x,e.y),{scene:a,labels:o}=t.store.get();(i?.flat??-1)!==r&&(r=i?.flat??-1,!i||!a?n():t.view.setOverlay(`flood`,Gp(Yp(i.flat,o,a.shape,fm)),dm))},stop:n}}var mm=`http://www.w3.org/2000/svg`,hm=class{svg=document.createElementNS(mm,`svg`);parts=new Map;constructor(e){this.svg.setAttribute(`class`,`marks`),this.svg.setAttribute(`aria-hidden`,`true`),e.append(this.svg)}polygon(e,t,n=!0){this.part(e,n?`polygon`:`polyline`).setAttribute(`points`,t.map(([e,t])=>`${e},${t}`).join(` `))}ruler(e,t,n,r){let i=this.part(e,`g`);i.replaceChildren();let a=[t,n].map(([e,t])=>gm(`circle`,{cx:e,cy:t,r:4})),[o,s]=[(t[0]+n[0])/2,(t[1]+n[1])/2],c=gm(`text`,{x:o,y:s-10,"text-anchor":`middle`});c.textContent=r,i.append(gm(`line`,{x1:t[0],y1:t[1],x2:n[0],y2:n[1]}),...a,c)}circle(e,t,n){let r=this.part(e,`circle`);r.setAttribute(`cx`,String(t[0])),r.setAttribute(`cy`,String(t[1])),r.setAttribute(`r`,String(n))}clear(e){this.parts.get(e)?.remove(),this.parts.delete(e)}part(e,t){let n=this.parts.get(e);if(n?.localName===t)return n;n?.remove();let r=gm(t,{});return r.setAttribute(`data-mark`,e),this.svg.append(r),this.parts.set(e,r),r}};function gm(e,t){let n=document.createElementNS(mm,e);for(let[e,r]of Object.entries(t))n.setAttribute(e,String(r));return n}var _m=4,vm=class{app;ends;desk;tools=new Map;gesture=null;chosen=null;right=null;constructor(e,t){this.app=e,this.ends=t;let n=e=>void(this.gesture=e);this.desk={app:e,selection:e.selection,marks:new hm(e.stage),begin:n},e.view.controls.claims=e=>this.claims(e),this.listen(),e.store.watch([`tool`],({tool:e})=>this.choose(e))}add(e){this.tools.set(e.id,e),e.id===this.app.store.get().tool&&this.choose(e.id)}get busy(){return this.gesture!==null}cancel(){let e=this.gesture;return this.gesture=null,e?.cancel(),e!==null}choose(e){let t=this.tools.get(e)??null;t!==this.chosen&&(this.cancel(),this.chosen?.hover?.(null),this.chosen?.stop?.(),this.chosen=t,this.app.canvas.style.cursor=t?.cursor??`default`,t?.start?.())}claims(e){if(this.gesture)return!0;let t=this.chosen;return t!==null&&(!t.claims||t.claims(this.pressOf(e)))}listen(){let{canvas:e}=this.app;e.addEventListener(`pointerdown`,e=>this.down(e)),e.addEventListener(`pointermove`,e=>this.move(e)),e.addEventListener(`pointerup`,e=>this.up(e)),e.addEventListener(`pointercancel`,()=>this.cancel()),e.addEventListener(`pointerleave`,()=>this.hover(null)),e.addEventListener(`wheel`,e=>this.wheel(e),{passive:!1}),window.addEventListener(`keydown`,e=>this.key(e),!0)}down(e){if(this.app.canvas.focus({preventScroll:!0}),e.button===2&&(this.right={x:e.clientX,y:e.clientY}),e.button!==0)return;let t=this.pressOf(e);this.gesture?.sticks?this.finish(t):this.claims(e)&&!this.gesture&&(this.gesture=this.chosen?.press(t)??null,this.gesture&&e.isTrusted&&this.app.canvas.setPointerCapture(e.pointerId))}move(e){let t=this.pressOf(e);this.app.pointer.at=t,this.gesture?this.gesture.move(t):this.hover(this.app.view.controls.dragging?null:t),this.ends.hover(t)}up(e){let t=this.pressOf(e);if(e.button===2&&this.right){let n=Math.hypot(e.clientX-this.right.x,e.clientY-this.right.y);this.right=null,n<_m&&!this.cancel()&&this.ends.rightClick(t,e)}else e.button===0&&this.gesture&&!this.gesture.sticks&&this.finish(t)}wheel(e){let t=this.chosen?.id===`brush`||this.chosen?.id===`erase`;e.ctrlKey&&t&&e.deltaY&&(e.preventDefault(),this.app.actions.run(e.deltaY<0?`brush.larger`:`brush.smaller`),this.hover(this.pressOf(e)))}finish(e){let t=this.gesture;this.gesture=null,t?.end(e)}hover(e){this.chosen?.hover?.(e),e||(this.app.pointer.at=null,this.ends.hover(null))}key(e){if(m(e.target))return;let t=this.gesture?.key?.(e)??(!this.gesture&&(this.chosen?.key?.(e)??!1));if(this.gesture?.sticks&&!t&&e.key===`Enter`)this.finish({...this.app.pointer.at??{x:0,y:0},...ym});else if(!t)return;e.preventDefault(),e.stopImmediatePropagation()}pressOf(e){let t=this.app.canvas.getBoundingClientRect(),{shiftKey:n,ctrlKey:r,metaKey:i,altKey:a}=e;return{x:e.clientX-t.left,y:e.clientY-t.top,shiftKey:n,ctrlKey:r,metaKey:i,altKey:a}}},ym={shiftKey:!1,ctrlKey:!1,metaKey:!1,altKey:!1};function bm(e){let{app:t,marks:r}=e,i=null,a=null,o=()=>{let e=i&&a?[t.view.project(i),t.view.project(a)]:[];i&&a&&e[0]&&e[1]?r.ruler(`measure`,e[0],e[1],xm(i,a)):r.clear(`measure`)},s=()=>{i=a=null,o()};t.view.onFrame.push(o);let c=e=>{a=t.view.pointAt(e.x,e.y)??a,o()};return{id:`measure`,cursor:`crosshair`,press:e=>{let r=t.view.pointAt(e.x,e.y);return r?(i=a=r,{move:c,end:()=>{i&&a&&t.store.set({status:n.tools.measured(xm(i,a))})},cancel:s}):null},stop:s}}function xm(e,t){let r=e.map((e,n)=>Math.abs(t[n]-e));return n.tools.distance(Math.hypot(...r),r)}var Sm=12;function Cm({store:e,view:t},n,r){let{objects:i,view:a}=e.get(),o=null,s=Sm;for(let e of i.values()){if(Tm(e.class_id,a.hidden,a.solo))continue;let i=t.project(e.center_m),c=i?Math.hypot(i[0]-n,i[1]-r):1/0;c<s&&([o,s]=[e,c])}return o}function wm(e,t,n){let r=Cm(e,t,n);if(r)return r;let i=e.view.pick(t,n);return i?.object&&e.store.get().objects.get(i.object)||null}function Tm(e,t,n){return n===null?t.has(e):n!==e}function Em(e,t){let n=[];for(let r=0;r<e.length;r++)e[r]===t&&n.push(r);return n}function Dm(e,t,n){let r=[];for(let i of e){let e=Up(i,n).map((e,n)=>e+t[n]);Wp(e,n)&&r.push(Hp(e,n))}return r}function Om({center_m:e,size_m:t,yaw_deg:n}){let r=n*Math.PI/180,[i,a]=[Math.abs(Math.cos(r)),Math.abs(Math.sin(r))],o=[(t[0]*i+t[1]*a)/2,(t[0]*a+t[1]*i)/2,t[2]/2];return{low:e.map((e,t)=>e-(o[t]??0)),high:e.map((e,t)=>e+(o[t]??0))}}var km=`#ffb35c`,Am={ArrowLeft:[-1,0,0],ArrowRight:[1,0,0],ArrowDown:[0,-1,0],ArrowUp:[0,1,0],PageUp:[0,0,1],PageDown:[0,0,-1]};function jm(e,t,r){let{view:i,store:a}=e.app,{scene:o,instance:s}=a.get(),c=Em(s,t.id),l=o?.shape??[1,1,1],u=o?.voxel_m??1,d=t.center_m[2],f=r&&i.toRoom(r.x,r.y,{axis:2,at:d}),p=[0,0,0],m=[0,0,0],h=r=>{m=r,i.setOverlay(`move`,Gp(Dm(c,m,l)),km);let a=Mm(t,m,u),o=i.project(a),s=i.project(t.center_m);o&&s&&e.marks.ruler(`move`,s,o,n.tools.moved(m))},g=()=>{i.setOverlay(`move`,null,km),e.marks.clear(`move`)};return{move:e=>{let t=i.toRoom(e.x,e.y,{axis:2,at:d});if(!t)return;f??=t;let n=f,r=t.map((e,t)=>Math.round((e-n[t])/u));h([(r[0]??0)+p[0],(r[1]??0)+p[1],p[2]])},key:e=>{let t=Am[e.key];return t?(p=p.map((e,n)=>e+t[n]),h(m.map((e,n)=>e+t[n])),!0):!1},end:()=>{g(),m.some(e=>e!==0)&&e.app.do({op:`move_object`,id:t.id,to_m:Mm(t,m,u)})},cancel:g}}function Mm(e,t,n){return e.center_m.map((e,r)=>e+t[r]*n)}function Nm(e){let{app:t}=e;return{id:`move`,cursor:`move`,start:()=>{let[n,...r]=t.store.get().selectedObjects,i=n===void 0||r.length?null:t.store.get().objects.get(n);if(!i)return;let a=jm(e,i,null),o=()=>{t.store.get().tool===`move`&&t.store.set({tool:`navigate`})};e.begin({...a,sticks:!0,end:e=>{a.end(e),o()},cancel:()=>{a.cancel(),o()}})},press:n=>{let r=wm(t,n.x,n.y);return r?(e.selection.objects([r.id]),jm(e,r,n)):null}}}var Pm=`#7fd6a4`,Fm=[`x`,`y`,`z`],Im={ArrowLeft:[-1,0,0],ArrowRight:[1,0,0],ArrowDown:[0,-1,0],ArrowUp:[0,1,0],PageUp:[0,0,1],PageDown:[0,0,-1]};function Lm(e){let{actions:t,store:r,toast:i}=e.app,a=[];t.on(`cells.copy`,{run:()=>{a=[...r.get().selectedCells],i(n.tools.copied(a.length))},why:()=>r.get().selectedCells.size?``:n.why.noCells}),t.on(`cells.paste`,{run:()=>e.begin(Rm(e,a)),why:()=>Dp(r)||(a.length?``:n.why.nothingCopied)})}function Rm({app:e},t){let{scene:r}=e.store.get(),i=r?.shape??[1,1,1],a=Xp(t,i)??{low:[0,0,0],high:[0,0,0]},o=[0,0,0],s=null,c=()=>{let n=t.map(e=>zm(Up(e,i),o,s,a)).filter(e=>Wp(e,i)).map(e=>Hp(e,i));e.view.setOverlay(`paste`,Gp(n),Pm)},l=()=>{e.view.setOverlay(`paste`,null,Pm),e.store.set({status:``})};return e.store.set({status:n.tools.pasting}),c(),{sticks:!0,move:({x:t,y:n})=>{let r=e.view.pick(t,n);if(!r)return;let i=[0,1].map(e=>Math.floor((a.low[e]+a.high[e])/2));o=[r.cell[0]-(i[0]??0),r.cell[1]-(i[1]??0),r.cell[2]+1-a.low[2]],c()},key:({key:e})=>{let t=Fm.find(t=>t===e.toLowerCase()),n=Im[e];if(t)s=s===t?null:t;else if(n)o=o.map((e,t)=>e+n[t]);else return!1;return c(),!0},end:()=>{l();let{locked:n}=e.store.get().view;e.do({op:`paste`,cells:Gp(t),by:o,mirror:s,locked:[...n]})},cancel:l}}function zm(e,t,n,r){return e.map((e,i)=>(Fm[i]===n?r.low[i]+r.high[i]-e:e)+t[i])}var Bm=4;function Vm(e){let{app:t}=e;Um(e);let n=()=>t.store.get().mode===`objects`;return{id:`navigate`,cursor:`default`,claims:e=>n()&&!e.shiftKey&&!e.ctrlKey&&Cm(t,e.x,e.y)!==null,press:t=>Hm(e,t),hover:e=>{let r=e&&n()?wm(t,e.x,e.y):null;t.canvas.style.cursor=r?`pointer`:`default`}}}function Hm(e,t){let n=Cm(e.app,t.x,t.y);if(!n)return null;let r=jm(e,n,t),i=!1;return{move:e=>{i||=Math.hypot(e.x-t.x,e.y-t.y)>=Bm,i&&r.move(e)},end:t=>{i?r.end(t):r.cancel(),e.selection.objects([n.id],i?`replace`:Op(t))},cancel:()=>r.cancel()}}function Um(e){let{app:t,selection:n}=e,r=null;t.canvas.addEventListener(`pointerdown`,e=>{r=t.store.get().tool===`navigate`&&e.button===0?{x:e.offsetX,y:e.offsetY}:null}),t.canvas.addEventListener(`pointerup`,e=>{if(!r||e.button!==0)return;let i=Math.hypot(e.offsetX-r.x,e.offsetY-r.y)>=Bm,{x:a,y:o}=r;r=null;let{mode:s}=t.store.get();if(i||s===`walk`||s===`build`||Cm(t,a,o))return;let c=wm(t,a,o);c?n.objects([c.id],Op(e)):Op(e)===`replace`&&n.objects([])})}var Wm=250;function Gm({store:e,connection:t}){let n=``,r=0,i=async r=>{let i=await t.ask(`warnings`).catch(()=>null);i&&r===n&&e.set({clashes:Km(i)})};e.watch([`scene`],({scene:e})=>{let t=e?`${e.document}.${e.rev}`:``;t!==n&&(n=t,clearTimeout(r),e&&(r=window.setTimeout(()=>void i(t),Wm)))})}function Km(e){let t=new Map;for(let n of e)for(let e of n.ids)t.set(e,[...t.get(e)??[],n]);return t}function qm(e,t){let n=(t.get(e)??[]).flatMap(({kind:e,ids:t})=>e===`collision`?t:[]);return[...new Set(n)].filter(t=>t!==e).sort((e,t)=>e-t)}function Jm(e,t){return(t.get(e)??[]).some(({kind:e})=>e===`outside`)}function Ym(e,{clashes:t,objects:r}){let a=qm(e,t).flatMap(e=>r.get(e)??[]).map(i);return[a.length?n.clashes.with(a.join(`, `)):``,Jm(e,t)?n.clashes.outside:``].filter(Boolean).join(`; `)}function Xm(e,t){let{actions:r,store:i}=t,a=c(`div`,{"aria-live":`polite`}),o=r.button(`cells.relabel`,{label:n.cellsPanel.relabel}),s=c(`div`,{class:`stack`},o,c(`div`,{class:`row is-even`},r.button(`cells.fillBox`,{label:n.cellsPanel.fillBox}),r.button(`cells.smooth`,{label:n.cellsPanel.smooth})),c(`div`,{class:`row is-even`},r.button(`select.none`,{label:n.cellsPanel.none}),r.button(`delete`,{icon:`trash`,label:n.cellsPanel.remove,class:`button is-danger`})));e.append(c(`div`,{class:`stack`},a,s)),i.watch([`selectedCells`,`scene`,`options`],({selectedCells:e,options:t})=>{let r=o.querySelector(`span`);r&&(r.textContent=n.cellsPanel.give(n.classes[t.classId]??``)),u(a,e.size?Zm(i):c(`p`,{class:`note`},n.cellsPanel.empty)),s.hidden=!e.size})}function Zm(e){let{selectedCells:t,labels:r,scene:i}=e.get(),a=new Map;for(let e of t){let t=r[e]??255;a.set(t,(a.get(t)??0)+1)}let o=[...a].sort((e,t)=>t[1]-e[1]).map(([e,t])=>c(`span`,{class:`chip`},c(`span`,{class:`swatch`,vars:{"--swatch":`rgb(${(i?.classes[e]?.colour??[128,128,128]).join(` `)})`}}),n.cellsPanel.chip(n.classes[e]??n.status.unseen,n.cells(t))));return c(`div`,{class:`stack`},c(`strong`,{},n.cells(t.size)),c(`div`,{class:`chips`},...o))}function Qm(e){let{actions:t,store:r,view:i,selection:a}=e,o=()=>r.get().selectedCells.size?``:n.why.noCells,s=()=>Dp(r)||o(),c=()=>({cells:Gp(r.get().selectedCells),locked:[...r.get().view.locked]});t.on(`cells.relabel`,{run:()=>void e.do({op:`set_cells`,...c(),class_id:r.get().options.classId,verb:`relabel`}),why:()=>s()||(r.get().options.classId?``:n.why.emptyClass)}),t.on(`cells.fillBox`,{run:()=>{let{scene:t,selectedCells:n,options:i,view:a}=r.get(),o=t&&Xp(n,t.shape);o&&e.do({op:`fill_box`,...o,class_id:i.classId,locked:[...a.locked]})},why:()=>s()||(r.get().options.classId?``:n.why.emptyClass)}),t.on(`cells.smooth`,{run:()=>{let{selectedCells:t}=r.get();e.do({op:`smooth`,...t.size?{runs:Gp(t)}:{}})},why:()=>Dp(r)}),t.on(`cells.component`,{run:()=>{let t=e.pointer.at,a=t&&i.pick(t.x,t.y);a?e.do({op:`delete_component`,cell:a.cell,locked:[...r.get().view.locked]}):e.toast(n.why.noPlace,`error`)},why:()=>Dp(r)||(e.pointer.at?``:n.why.noPlace)}),r.watch([`selectedCells`,`scene`],({selectedCells:e})=>i.setOverlay(`selection`,e.size?Gp(e):null,$m)),e.connection.onChange(()=>{let{selectedCells:e,labels:t}=r.get(),n=[...e].filter(e=>(t[e]??255)%255!=0);n.length<e.size&&a.cells(n)})}var $m=`#ffd9a0`;function eh({store:e}){let{labels:t,scene:n,view:r}=e.get(),i=[];return t.forEach((e,t)=>{e%255!=0&&!(r.solo===null?r.hidden.has(e):r.solo!==e)&&n&&th(Up(t,n.shape),r)&&i.push(t)}),i}function th(e,{slice:t,section:n}){return t&&((e[t.axis]??0)<t.low||(e[t.axis]??0)>t.high)?!1:!n||e.every((e,t)=>e>=n.low[t]&&e<=n.high[t])}var nh=`sceneforge.panels`;function rh(e,t,n){for(let r of k.panels(t))e.append(ih(r,n))}function ih(e,t){let n=c(`div`,{class:`panel-body`,id:`panel-${e.id}`}),r=c(`button`,{type:`button`,class:`panel-title`,"aria-controls":n.id},c(`span`,{},e.title),Cd(`down`)),i=c(`section`,{class:`panel`,data:{panel:e.id}},c(`h2`,{},r),n),a=sh()[e.id]??!e.closed,o=()=>{r.setAttribute(`aria-expanded`,String(a)),n.hidden=!a};return r.addEventListener(`click`,()=>{a=!a,ch(e.id,a),o()}),o(),e.mount(n,t),t.store.watch([`mode`],({mode:t})=>{i.hidden=e.modes!==`all`&&!e.modes.includes(t)}),i}function ah(e){let t=document.querySelector(`[data-panel="${e}"]`),n=t?.querySelector(`.panel-title`);n?.getAttribute(`aria-expanded`)===`false`&&n.click(),t?.scrollIntoView({block:`nearest`})}function oh(e,t){let r=k.panels(`drawer`),i=c(`div`,{class:`drawer-tabs`,role:`tablist`,"aria-label":n.panels.drawer}),a=c(`div`,{class:`drawer-bodies`}),o=null,s=r.map(e=>{let n=`drawer-${e.id}`,r=c(`button`,{type:`button`,role:`tab`,class:`drawer-tab`,"aria-controls":n});r.append(e.title);let s=c(`div`,{id:n,role:`tabpanel`,class:`drawer-body`});return e.mount(s,t),r.addEventListener(`click`,()=>{o=o===e.id?null:e.id,l()}),i.append(r),a.append(s),{panel:e,tab:r,body:s}}),l=()=>{let{mode:n}=t.store.get();for(let{panel:e,tab:t,body:r}of s){let i=e.modes===`all`||e.modes.includes(n);t.hidden=!i,t.setAttribute(`aria-selected`,String(i&&o===e.id)),r.hidden=!i||o!==e.id}e.hidden=s.every(({tab:e})=>e.hidden)};Fd(i),e.append(i,a),t.store.watch([`mode`],l)}function sh(){try{return JSON.parse(localStorage.getItem(nh)??`{}`)}catch{return{}}}function ch(e,t){localStorage.setItem(nh,JSON.stringify({...sh(),[e]:t}))}var lh=`#ff5252`,uh=60;function dh(e,t){let r=40,i=[],a=!1,o=c(`div`,{class:`found-list`,role:`group`,"aria-label":n.floaters.title}),s=c(`p`,{class:`note`,"aria-live":`polite`},n.floaters.note),l=e=>t.view.setOverlay(`floaters`,e.length?e.flatMap(e=>e.runs):null,lh),d=()=>{l(i),s.textContent=a?n.floaters.found(i.length,mh(i)):n.floaters.note,u(o,...i.slice(0,uh).map(e=>fh(t,e,()=>l([e]),()=>l(i)))),p(y,Dp(t.store)||(i.length?``:n.why.noFloaters),n.floaters.deleteAll)},f=async()=>{a=!0,i=await t.ask(`floaters`,{max_cells:r})??[],d()},m=()=>{a=!1,i=[],d()},g=h({label:n.floaters.size,id:`floater-size`,min:1,max:400,step:1,show:n.cells,change:e=>{r=e,a&&f()}});g.set(r);let _=v(n.floaters.find,()=>void f()),y=v(n.floaters.deleteAll,()=>void t.do({op:`remove_floaters`,max_cells:r}),`button is-danger`);_.dataset.do=`find-floaters`,y.dataset.do=`delete-floaters`,e.append(c(`div`,{class:`stack`},g.node,c(`div`,{class:`row is-even`},_,y),s,o)),Fd(o),d(),t.actions.on(`floaters.find`,{run:()=>{ah(`floaters`),f()},why:()=>t.store.get().scene?``:n.why.noScene}),t.store.watch([`online`,`scene`],d),t.connection.onChange(()=>a&&void f()),t.store.watch([`mode`],({mode:e})=>e!==`voxels`&&a&&m())}function fh(e,t,r,i){let a=e.store.get().scene?.classes[t.class_id]?.colour??[128,128,128],o=c(`button`,{type:`button`,class:`found`,title:n.floaters.select},c(`span`,{class:`swatch`,vars:{"--swatch":`rgb(${a.join(` `)})`}}),c(`span`,{class:`tree-word`},n.classes[t.class_id]),c(`span`,{class:`legend-count`},n.cells(t.cells)));for(let e of[`pointerenter`,`focus`])o.addEventListener(e,r);for(let e of[`pointerleave`,`blur`])o.addEventListener(e,i);return o.addEventListener(`click`,()=>{let{scene:n}=e.store.get(),r=Kp(t.runs);e.store.set({selectedCells:new Set(r)}),n&&ph(e,r)}),o}function ph({store:e,view:t},n){let{scene:r}=e.get();if(!r||!n.length)return;let i=n.map(e=>Up(e,r.shape)),a=(e,t,n)=>r.origin_m[e]+(i.reduce((t,r)=>n(t,r[e]),i[0]?.[e]??0)+t)*r.voxel_m,o=[a(0,0,Math.min),a(1,0,Math.min),a(2,0,Math.min)],s=[a(0,1,Math.max),a(1,1,Math.max),a(2,1,Math.max)];t.focus({low:o,high:s})}function mh(e){return e.reduce((e,t)=>e+t.cells,0)}var hh=null;function gh(e,t){let n=c(`button`,{type:`button`,class:e.class,"aria-haspopup":`menu`,"aria-expanded":`false`,title:e.title??e.label,data:{menu:e.id}},e.label);return n.addEventListener(`click`,()=>{if(hh?.owner===n)vh();else{let e=n.getBoundingClientRect();_h(t(),e.left,e.bottom+4,n,e.right)}}),n}function _h(e,t,n,r=null,i=t){vh();let a=c(`div`,{class:`menu`,role:`menu`},...e.map(bh));document.body.append(a);let{width:o,height:s}=a.getBoundingClientRect(),l=t+o>innerWidth-8?Math.max(8,Math.min(i,innerWidth-8)-o):t,u=n+s>innerHeight-8?Math.max(8,innerHeight-8-s):n;a.style.left=`${l}px`,a.style.top=`${u}px`,Fd(a,`[role=menuitem]`),r?.setAttribute(`aria-expanded`,`true`),hh={node:a,owner:r},a.querySelector(`[role=menuitem]`)?.focus(),addEventListener(`pointerdown`,yh,!0)}function vh(){if(!hh)return!1;let{node:e,owner:t}=hh;hh=null,removeEventListener(`pointerdown`,yh,!0);let n=e.contains(document.activeElement);return e.remove(),t?.setAttribute(`aria-expanded`,`false`),n&&(t??document.querySelector(`.canvas`))?.focus(),!0}function yh(e){let t=e.target;!hh?.node.contains(t)&&!hh?.owner?.contains(t)&&vh()}function bh(e){let t=c(`button`,{type:`button`,role:`menuitem`,class:e.danger?`menu-item is-danger`:`menu-item`},e.swatch&&c(`span`,{class:`swatch`,vars:{"--swatch":e.swatch}}),c(`span`,{class:`menu-label`},e.label),e.hint&&c(`span`,{class:`menu-hint`},e.hint));return e.why&&(t.setAttribute(`aria-disabled`,`true`),t.setAttribute(`aria-description`,e.why),t.title=e.why),t.addEventListener(`click`,()=>{e.why||(vh(),e.run())}),t}var xh={density_kernel:3,density_threshold:.2,cluster_radius:2},Sh={density_kernel:[1,9,2],density_threshold:[0,1,.02],cluster_radius:[1,10,.5]},Ch=150;function wh(e,t){e.do({op:`recluster`,...t===null?{}:{class_id:t},...xh})}function Th(e,t){let r=c(`p`,{class:`note`,"aria-live":`polite`},n.recluster.note),i=c(`div`,{class:`centre-preview`,"aria-hidden":`true`});t.stage.append(i);let a=[],o=0,s=0,l=()=>Dh(t,i,a);t.view.onFrame.push(l);let u=()=>{s+=1,a=[],i.replaceChildren(),r.textContent=n.recluster.note},d=async()=>{let e=++s,o=await t.ask(`centers`,{...xh});o&&e===s&&(a=o,r.textContent=n.recluster.found(a.length,t.store.get().objects.size),Eh(t,i,a),l())},f=Object.keys(xh).map(e=>{let[t,r,i]=Sh[e],a=h({label:n.recluster[e],id:e,min:t,max:r,step:i,show:e===`density_threshold`?String:n.cells,change:t=>{xh[e]=t,clearTimeout(o),o=window.setTimeout(()=>void d(),Ch)}});return a.set(xh[e]),a.node}),m=v(n.recluster.run,()=>{wh(t,null),u()},`button is-wide`),g=v(n.recluster.hide,u);e.append(c(`div`,{class:`stack`},...f,r,c(`div`,{class:`row is-even`},m,g))),t.store.watch([`scene`,`online`],()=>p(m,Dp(t.store),n.recluster.run)),t.store.watch([`mode`],({mode:e})=>e!==`objects`&&u())}function Eh({store:e},t,n){let r=e.get().scene?.classes??[];t.replaceChildren(...n.map(({class_id:e})=>c(`i`,{vars:{"--swatch":`rgb(${(r[e]?.colour??[255,255,255]).join(` `)})`}})))}function Dh({view:e},t,n){n.forEach(({at_m:n},r)=>{let i=t.children[r],a=e.project(n);i&&(i.hidden=!a,a&&(i.style.transform=`translate(${a[0]}px, ${a[1]}px)`))})}var Oh=5;function kh(e,t,n){let r=n.getBoundingClientRect();_h(Ah(e,t,n),r.left,r.bottom+4,n,r.right)}function Ah(e,t,r){let{store:i}=e,{scene:a,view:o}=i.get(),s=n.classes[t]??``,c=a?.counts[t]?``:n.why.noneOfClass(s),l=o.locked.has(t)?n.why.locked(s):``,u=Dp(i)||c||l,d=[{label:n.legend.relabel,why:u,run:()=>Mh(e,t,r)},{label:n.legend.deleteAll(s),why:u,danger:!0,run:()=>void e.do({op:`delete_class`,class_id:t})}];return[{label:n.legend.solo(s),hint:`Alt+click`,run:()=>i.setView({solo:o.solo===t?null:t})},{label:n.legend.selectCells(s),why:c,run:()=>Nh(e,t)},...t>=Oh?jh(e,t,u):[],...d]}function jh(e,t,r){let i=n.classes[t]??``,a=[...e.store.get().objects.values()].filter(e=>e.class_id===t).map(e=>e.id),o=r||(a.length<2?n.why.tooFew(i):``),s=r||(a.length?``:n.why.noObjects(i));return[{label:n.legend.selectObjects(i),why:a.length?``:n.why.noObjects(i),run:()=>e.store.set({mode:`objects`,selectedObjects:new Set(a)})},{label:n.legend.mergeAll,why:o,run:()=>void e.do({op:`merge_objects`,ids:a})},{label:n.legend.splitEach,why:s,run:()=>void e.do({op:`split_objects`,ids:a,parts:2})},{label:n.legend.rematch,why:s,run:()=>void e.do({op:`rematch`,ids:a})},{label:n.legend.recluster,hint:n.legend.splits,why:r,run:()=>wh(e,t)}]}function Mh(e,t,r){let i=r.getBoundingClientRect();_h((e.store.get().scene?.classes??[]).filter(({id:e})=>e&&e!==t).map(({id:r,colour:i})=>({label:n.classes[r]??String(r),swatch:`rgb(${i.join(` `)})`,run:()=>void e.do({op:`relabel_class`,from_id:t,to_id:r})})),i.left,i.bottom+4,r,i.right)}function Nh({store:e},t){let{labels:n}=e.get(),r=new Set;n.forEach((e,n)=>e===t&&r.add(n)),e.set({mode:`voxels`,selectedCells:r})}var Ph=4;function Fh(e,t){let r=c(`div`,{class:`legend`,role:`group`,"aria-label":n.legend.title});e.append(r),Fd(r,`button`,Ph);let i=new Map;t.store.watch([`scene`,`view`,`options`],e=>{if(e.scene){for(let{id:n,colour:a}of e.scene.classes)if(!i.has(n)){let e=Ih(t,n,`rgb(${a.join(` `)})`);i.set(n,e),n?r.insertBefore(e.node,i.get(0)?.node??null):r.append(e.node)}for(let[t,n]of i)Lh(n,t,e)}})}function Ih(e,t,r){let{store:i}=e,a=n.classes[t]??String(t),o=c(`span`,{class:`legend-count`}),s=c(`button`,{type:`button`,class:`legend-name`,on:{click:()=>i.setOptions({classId:t})}},c(`span`,{class:`swatch`,vars:{"--swatch":r}}),c(`span`,{class:`legend-word`},a),o,c(`kbd`,{class:`legend-key`},zh(t))),l=c(`button`,{type:`button`,class:`mini`}),u=c(`button`,{type:`button`,class:`mini`}),d=c(`button`,{type:`button`,class:`mini`,"aria-haspopup":`menu`},Cd(`more`));d.title=n.legend.more(a),d.setAttribute(`aria-label`,d.title),l.addEventListener(`click`,n=>Bh(e,t,n.altKey)),u.addEventListener(`click`,()=>Vh(e,t)),d.addEventListener(`click`,()=>kh(e,t,d));let f=c(`div`,{class:`legend-row`,data:{class:String(t)}},s,d,u,l);if(!t)for(let e of[l,u,d])e.style.visibility=`hidden`;return{node:f,name:s,count:o,eye:l,lock:u}}function Lh(e,t,{scene:r,view:i,options:a}){let o=n.classes[t]??String(t),s=r?.counts[t]??0,c=i.solo===null?i.hidden.has(t):i.solo!==t,l=i.locked.has(t);e.count.textContent=t?s.toLocaleString(`en`):``,e.name.setAttribute(`aria-pressed`,String(a.classId===t)),e.name.title=n.legend.choose(o,zh(t)),e.node.classList.toggle(`is-hidden`,c&&t>0),e.node.classList.toggle(`is-none`,s===0&&t>0),e.node.classList.toggle(`is-locked`,l),u(e.eye,Cd(c?`eyeOff`:`eye`)),u(e.lock,Cd(l?`lock`:`unlock`)),Rh(e.eye,!c,n.legend.seen(o,!c,i.solo===t)),Rh(e.lock,l,n.legend.locked(o,l))}function Rh(e,t,n){e.setAttribute(`aria-pressed`,String(t)),e.setAttribute(`aria-label`,n),e.title=n}function zh(e){return e===0?`=`:e===10?`0`:e===11?`-`:String(e)}function Bh({store:e},t,n){let{view:r}=e.get();n?e.setView({solo:r.solo===t?null:t}):r.solo===null?e.setView({hidden:Hh(r.hidden,t)}):e.setView({solo:r.solo===t?null:t})}function Vh({store:e},t){e.setView({locked:Hh(e.get().view.locked,t)})}function Hh(e,t){let n=new Set(e);return n.delete(t)||n.add(t),n}function Uh(e,t,n){let{mode:r}=e.store.get();if(r===`walk`||r===`build`)return;let i=r===`objects`?Cm(e,t.x,t.y):null;if(i){let t=Dp(e.store);t?e.toast(t,`error`):e.do({op:`delete_objects`,ids:[i.id]})}else _h(Wh(e,t),n.clientX,n.clientY)}function Wh(e,t){let{store:r,actions:i}=e,a=e.view.pick(t.x,t.y),o=wm(e,t.x,t.y),s=a?r.get().labels[a.flat]??0:0,c=n.classes[s]??``,l=a?``:n.why.noPlace;return[...o?[{label:n.context.select(o.title,o.id),run:()=>void(o&&r.set({selectedObjects:new Set([o.id])}))}]:[],{label:n.context.focus,hint:`F`,why:l,run:()=>a&&ph(e,[a.flat])},{label:n.context.hide(c),hint:`\\`,why:l,run:()=>Bh(e,s,!1)},{label:n.context.take(c),hint:`I`,why:l,run:()=>r.setOptions({classId:s})},{label:n.context.component,hint:`Shift+Delete`,why:l||Dp(r),danger:!0,run:()=>a&&void e.do({op:`delete_component`,cell:a.cell,locked:[...r.get().view.locked]})},{label:n.action[`view.reset`],hint:`Shift+F`,run:()=>i.run(`view.reset`)}]}var Gh=[`class`,`confidence`,`colour`,`difference`];function Kh(e,{store:t}){let r=n.display,i=h({label:r.voxelSize,id:`voxel-size`,min:.3,max:1,step:.05,show:n.percent,change:e=>t.setView({voxelSize:e})}),a=h({label:r.opacity,id:`opacity`,min:.05,max:1,step:.05,show:n.percent,change:e=>t.setView({opacity:e})}),o=h({label:r.centerSize,id:`center-size`,min:0,max:.4,step:.02,show:n.centimetres,change:e=>t.setView({centerSize:e})}),s=_(r.edges,`edges`,e=>t.setView({edges:e})),l=g(r.colourBy,()=>Gh.map(e=>({value:e,label:r.colours[e],why:qh(e,t.get().scene?.has.truth)})),e=>t.setView({colourBy:e})),d=c(`p`,{class:`note colour-legend`});e.append(c(`div`,{class:`stack`},i.node,a.node,o.node,s.node),c(`h3`,{class:`sub`},r.colourBy),l.node,d),t.watch([`view`,`scene`],({view:e})=>{i.set(e.voxelSize),a.set(e.opacity),o.set(e.centerSize),s.set(e.edges),l.set(e.colourBy);let t=e.colourBy===`confidence`&&c(`span`,{class:`ramp`});u(d,t&&r.doubtful,t,r.legends[e.colourBy])})}function qh(e,t){return e===`difference`&&!t?n.why.nothingToCompare:``}var Jh=.6;function Yh(e,t){let r=[],i=-1,a=-1,o=c(`p`,{class:`note`,"aria-live":`polite`},n.doubtful.note),s=c(`div`,{class:`found-list`,role:`group`,"aria-label":n.doubtful.title}),l=()=>{u(s,...r.slice(0,40).map((e,t)=>Xh(e,t,t===i,d))),a>=0&&(o.textContent=r.length?n.doubtful.at(i+1,r.length):n.doubtful.none)},d=e=>{i=e;let n=r[e];l(),n&&(Qh(t,n),t.store.set({status:Zh(n.why)}))},f=async e=>{let o=t.store.get().scene?.rev??0;if(o!==a){let e=await t.ask(`doubtful`);if(!e)return;r=e,a=o,i=Math.min(i,r.length-1)}r.length||t.toast(n.doubtful.none),d(r.length?(i+e+r.length+ +(i<0&&e<0))%r.length:-1)},p=()=>t.store.get().scene?``:n.why.noScene,m=e=>{ah(`doubtful`),f(e)};t.actions.on(`doubtful.next`,{run:()=>m(1),why:p}),t.actions.on(`doubtful.previous`,{run:()=>m(-1),why:p});let h=v(n.doubtful.next,()=>void f(1)),g=v(n.doubtful.previous,()=>void f(-1));e.append(c(`div`,{class:`stack`},c(`div`,{class:`row is-even`},g,h),o,s)),Fd(s)}function Xh(e,t,n,r){let i=c(`button`,{type:`button`,class:`found`,data:{doubt:String(t)}});return i.append(c(`span`,{class:`found-at`},t+1),c(`span`,{class:`found-why`},Zh(e.why))),i.setAttribute(`aria-pressed`,String(n)),i.addEventListener(`click`,()=>r(t)),i}function Zh(e){return e.charAt(0).toUpperCase()+e.slice(1)}function Qh({store:e,view:t},n){let r=n.object_id?e.get().objects.get(n.object_id):void 0;r&&e.set({selectedObjects:new Set([r.id])});let i={low:n.at_m.map(e=>e-Jh),high:n.at_m.map(e=>e+Jh)};t.focus(r?Om(r):i)}var $h=`#7fd6a4`;function eg(e,t){let r=[],i=!1,a=c(`p`,{class:`note`,"aria-live":`polite`},n.holes.note),o=c(`div`,{class:`found-list`,role:`group`,"aria-label":n.holes.title}),s=e=>t.view.setOverlay(`holes`,e.length?e.flatMap(e=>e.runs):null,$h),l=()=>{let e=r.filter(e=>e.cells>0);s(e),a.textContent=i?n.holes.found(e.length):n.holes.note,u(o,...e.map(n=>tg(t,n,()=>s([n]),()=>s(e))))},d=async()=>{i=!0,r=await t.ask(`holes`)??[],l()},f=v(n.holes.find,()=>void d(),`button is-wide`);f.dataset.do=`find-holes`,e.append(c(`div`,{class:`stack`},f,a,o)),Fd(o),t.actions.on(`holes.fill`,{run:()=>{ah(`holes`),d()},why:()=>t.store.get().scene?``:n.why.noScene}),t.connection.onChange(()=>i&&void d()),t.store.watch([`mode`],({mode:e})=>{e!==`voxels`&&i&&(i=!1,r=[],l())})}function tg(e,t,r,i){let a=c(`button`,{type:`button`,class:`found`,data:{plane:t.plane}},c(`span`,{class:`tree-word`},n.holes.plane(t.plane)),c(`span`,{class:`muted`},n.holes.share(t.share)),c(`span`,{class:`legend-count`},n.holes.fill(t.cells)));p(a,Dp(e.store),n.holes.fillOne(t.plane));for(let e of[`pointerenter`,`focus`])a.addEventListener(e,r);for(let e of[`pointerleave`,`blur`])a.addEventListener(e,i);return a.addEventListener(`click`,()=>{Dp(e.store)||e.do({op:`fill_holes`,plane:t.plane})}),a}var ng=5;function rg(e,t){let{store:r,connection:i}=t,a=c(`div`,{class:`stack`});e.append(a);let o=``,s=0;r.watch([`objects`,`selectedObjects`,`online`],()=>{let{selectedObjects:e,objects:l,online:d}=r.get(),f=[...e].flatMap(e=>l.get(e)??[]),[p]=f,m=JSON.stringify([f,d]);if(m!==o){if(o=m,s+=1,!p)u(a,c(`p`,{class:`note`},n.inspector.none));else if(f.length>1)u(a,...og(t,f));else{let e=c(`div`,{class:`templates`,role:`group`,"aria-label":n.inspector.templates});u(a,...ag(t,p,e)),lg(t,p,e,p.placements[0]?.alternatives??[]);let r=s;i.ask(`alternatives`,{id:p.id}).then(n=>r===s&&lg(t,p,e,n)).catch(()=>void 0)}}}),r.watch([`clashes`,`objects`,`selectedObjects`],()=>{let e=a.querySelector(`.clashes`),[n]=r.get().selectedObjects;e&&n!==void 0&&u(e,...ig(t,n))})}function ig({store:e,selection:t},r){let{clashes:a,objects:o}=e.get(),s=qm(r,a).flatMap(e=>o.get(e)??[]).map(e=>c(`button`,{type:`button`,class:`link`,data:{clash:String(e.id)},on:{click:()=>t.objects([e.id])}},i(e)));return[s.length>0&&c(`p`,{class:`clash`},Cd(`warn`),c(`span`,{},n.clashes.collides),...s),Jm(r,a)&&c(`p`,{class:`clash`},Cd(`warn`),c(`span`,{},n.clashes.outside))].filter(e=>e!==!1)}function ag(e,t,r){let{actions:a}=e;return[c(`div`,{class:`object-title`},c(`span`,{class:`swatch`,vars:{"--swatch":pg(e,t.class_id)}}),c(`strong`,{},i(t)),c(`span`,{class:`muted`},n.inspector.confidence(t.confidence))),c(`div`,{class:`clashes`,role:`status`,"aria-label":n.clashes.title}),sg(e,[t]),cg(e,[t]),c(`h3`,{class:`sub`},n.inspector.templates),r,c(`div`,{class:`row is-even`},a.button(`object.templateBack`,{label:n.inspector.previous}),a.button(`object.template`,{label:n.inspector.next})),dg(e,t),fg(t),c(`div`,{class:`row is-even`},a.button(`object.floor`,{icon:`floor`,label:n.inspector.floor}),a.button(`object.wall`,{icon:`wall`,label:n.inspector.wall})),c(`div`,{class:`row is-even`},a.button(`object.duplicate`,{icon:`duplicate`,label:n.inspector.duplicate}),a.button(`object.split`,{icon:`split`,label:n.inspector.split})),c(`div`,{class:`row is-even`},a.button(`object.rematch`,{icon:`template`,label:n.inspector.rematch}),a.button(`delete`,{icon:`trash`,label:n.inspector.remove,class:`button is-danger`}))]}function og(e,t){let{actions:r}=e;return[c(`strong`,{},n.inspector.several(t.length)),sg(e,t),cg(e,t),c(`div`,{class:`row is-even`},r.button(`object.turn`,{icon:`turn`,label:n.inspector.turnRight}),r.button(`object.merge`,{icon:`merge`,label:n.inspector.merge})),c(`div`,{class:`row is-even`},r.button(`object.rematch`,{icon:`template`,label:n.inspector.rematch}),r.button(`delete`,{icon:`trash`,label:n.inspector.remove,class:`button is-danger`}))]}function sg(e,t){let[r]=t,i=t.every(e=>e.title===r?.title)?r?.title??``:``,a=c(`datalist`,{id:`object-names`},...o(r?.class_id??0).map(e=>c(`option`,{value:e}))),s=c(`input`,{type:`text`,maxlength:60,value:i,list:a.id,data:{field:`name`},"aria-label":n.inspector.name}),l=Dp(e.store);return p(s,l,r?n.inspector.nameOf(r.name_confidence):``),s.disabled=l!==``,s.addEventListener(`change`,()=>{s.value.trim()!==i&&e.do({op:`rename_objects`,ids:t.map(e=>e.id),name:s.value}).then(e=>e===null&&(s.value=i))}),c(`label`,{class:`field is-plain`},c(`span`,{},n.inspector.name),s,a)}function cg(e,t){let r=(e.store.get().scene?.classes??[]).filter(({id:e})=>e>=ng),i=t.every(e=>e.class_id===t[0]?.class_id),a=c(`select`,{data:{field:`class`},"aria-label":n.inspector.class},!i&&c(`option`,{value:``},n.inspector.mixed),...r.map(({id:e})=>c(`option`,{value:e},n.classes[e])));return a.value=i?String(t[0]?.class_id):``,p(a,Dp(e.store),n.inspector.class),a.disabled=Dp(e.store)!==``,a.addEventListener(`change`,()=>{e.do({op:`relabel_objects`,ids:t.map(e=>e.id),class_id:Number(a.value)}).then(e=>e===null&&(a.value=String(t[0]?.class_id)))}),c(`label`,{class:`field is-plain`},c(`span`,{},n.inspector.class),a)}function lg(e,t,r,i){let a=t.placements[0],o=a?[{template:a.template,quarter_turns:a.quarter_turns,iou:a.iou},...i]:[...i],s=o.filter((e,t)=>o.findIndex(t=>t.template===e.template&&t.quarter_turns===e.quarter_turns)===t);s.length?(u(r,...s.slice(0,6).map(n=>ug(e,t,n,n===s[0]&&a!==void 0))),Fd(r)):u(r,c(`p`,{class:`note`},n.inspector.noTemplate))}function ug(e,t,r,i){let a=r.template===ip,o=c(`button`,{type:`button`,class:`template`,data:{template:r.template},vars:{"--share":a?`0%`:`${r.iou*100}%`}},c(`span`,{class:`template-name`},n.templateName(r.template)),c(`span`,{class:`template-turn`},`${r.quarter_turns*90}°`),!a&&c(`span`,{class:`template-iou`},n.objects.fit(r.iou)));o.setAttribute(`aria-pressed`,String(i));let s=n.templateName(r.template);return p(o,Dp(e.store),a?s:n.inspector.iouOf(s,r.iou)),o.addEventListener(`click`,()=>{if(i||Dp(e.store))return;let{template:n,quarter_turns:a}=r;e.do({op:`set_template`,id:t.id,template:n,quarter_turns:a})}),o}function dg(e,t){let r=(Math.round(t.yaw_deg/90)%4+4)%4,i=[0,1,2,3].map(i=>{let a=c(`button`,{type:`button`,data:{turn:String(i)}},`${i*90}°`);return a.setAttribute(`aria-pressed`,String(i===r)),p(a,Dp(e.store),n.inspector.turnTo(i*90)),a.addEventListener(`click`,()=>{let n=(i-r+4)%4;n&&!Dp(e.store)&&e.do({op:`turn_objects`,ids:[t.id],quarter_turns:n})}),a}),a=c(`div`,{class:`segment`,role:`group`,"aria-label":n.inspector.turn},...i);return Fd(a),c(`div`,{class:`field is-plain`},c(`span`,{},n.inspector.turn),a)}function fg(e){return c(`dl`,{class:`facts`},...[[n.inspector.size,n.metres(e.size_m)],[n.inspector.place,n.position(e.center_m)],[n.inspector.cells,e.cells.toLocaleString(`en`)]].flatMap(([e,t])=>[c(`dt`,{},e),c(`dd`,{},t)]))}function pg({store:e},t){return`rgb(${(e.get().scene?.classes[t]?.colour??[128,128,128]).join(` `)})`}var mg=5;function hg({store:e}){let{selectedObjects:t,objects:n}=e.get();return[...t].flatMap(e=>n.get(e)??[])}function gg(e){let{actions:t,store:r}=e,i=()=>Dp(r)||(hg(e).length?``:n.why.noObject),a=()=>i()||(hg(e).length===1?``:n.why.oneObject),o=()=>i()||(hg(e).length>1?``:n.why.twoObjects),s=()=>hg(e).map(({id:e})=>e),c=(n,r,i)=>t.on(n,{why:r,run:()=>void e.do({op:``,...i()})});c(`object.turn`,i,()=>({op:`turn_objects`,ids:s(),quarter_turns:1})),c(`object.turnBack`,i,()=>({op:`turn_objects`,ids:s(),quarter_turns:3})),c(`object.split`,a,()=>({op:`split_object`,id:s()[0],parts:2})),c(`object.merge`,o,()=>({op:`merge_objects`,ids:s()})),c(`object.duplicate`,a,()=>({op:`duplicate_object`,id:s()[0]})),c(`object.floor`,a,()=>({op:`snap_object`,id:s()[0],to:`floor`})),c(`object.wall`,a,()=>({op:`snap_object`,id:s()[0],to:`wall`})),c(`object.rematch`,i,()=>({op:`rematch`,ids:s()}));let l=()=>r.get().options.classId<mg?n.why.notAnObject:``;c(`object.relabel`,()=>i()||l(),()=>({op:`relabel_objects`,ids:s(),class_id:r.get().options.classId})),t.on(`object.template`,{why:a,run:()=>void yg(e,1)}),t.on(`object.templateBack`,{why:a,run:()=>void yg(e,-1)}),t.on(`object.next`,{why:()=>_g(e),run:()=>xg(e,1)}),t.on(`object.previous`,{why:()=>_g(e),run:()=>xg(e,-1)})}function _g({store:e}){return e.get().objects.size?``:n.why.noObjects(``)}var vg=new Map;async function yg(e,t){let[r]=hg(e);if(!r)return;let i=vg.get(r.id)??[];if(i.findIndex(e=>bg(r,e))<0){if(i=[...await e.ask(`alternatives`,{id:r.id})??[]],!i.length)return;let t=r.placements[0];t&&!i.some(e=>bg(r,e))&&i.unshift({...t}),vg.set(r.id,i)}let a=i.findIndex(e=>bg(r,e)),o=i[(Math.max(a,0)+t+i.length)%i.length];if(!o||i.length<2)return e.toast(n.why.noOtherTemplate);let{template:s,quarter_turns:c}=o;await e.do({op:`set_template`,id:r.id,template:s,quarter_turns:c})}function bg(e,t){let n=e.placements[0];return n?.template===t.template&&n.quarter_turns===t.quarter_turns}function xg(e,t){let n=[...e.store.get().objects.values()].sort((e,t)=>e.class_id-t.class_id||e.id-t.id),r=n.findIndex(({id:t})=>e.store.get().selectedObjects.has(t)),i=n[(r+(r<0&&t<0?0:t)+n.length)%n.length];i&&(e.selection.objects([i.id]),e.view.focus(Om(i)))}function Sg(e,t){let{store:r}=t,i=c(`ul`,{class:`tree`,role:`tree`,"aria-label":n.objects.title});i.setAttribute(`aria-multiselectable`,`true`);let a=new Set,o=c(`input`,{type:`search`,class:`tree-search`,placeholder:n.objects.find,title:n.objects.search,"aria-label":n.objects.search,autocomplete:`off`,spellcheck:`false`});e.append(o,i);let s=()=>{let e=i.contains(document.activeElement)?document.activeElement.dataset.key:void 0,s=o.value.trim();u(i,...Cg(t,s?new Set:a,s));let l=r.get().objects.size?n.objects.notFound:n.objects.none;i.children.length||i.append(c(`li`,{class:`note`},l)),Dg(i,e)};r.watch([`objects`,`selectedObjects`,`clashes`],s),o.addEventListener(`input`,s),i.addEventListener(`click`,e=>{let n=e.target.closest(`[role=treeitem]`);n&&(n.focus(),n.dataset.object?Tg(t,Number(n.dataset.object),e):n.dataset.branch&&(Eg(a,Number(n.dataset.branch)),s()))}),i.addEventListener(`keydown`,e=>Og(e,i)),i.addEventListener(`focusin`,e=>Dg(i,e.target.dataset.key))}function Cg({store:e},t,r){let{objects:i,scene:o}=e.get(),s=new Map;for(let e of i.values())(!r||a(e,r))&&s.set(e.class_id,[...s.get(e.class_id)??[],e]);return(o?.classes??[]).filter(({id:e})=>s.has(e)).flatMap(({id:r,colour:i})=>{let a=s.get(r)??[];return[c(`li`,{role:`treeitem`,class:`tree-branch`,tabindex:`-1`,"aria-level":`1`,"aria-expanded":String(!t.has(r)),data:{branch:String(r),key:`b${r}`}},Cd(`down`),c(`span`,{class:`swatch`,vars:{"--swatch":`rgb(${i.join(` `)})`}}),c(`span`,{class:`tree-word`},n.classes[r]),c(`span`,{class:`legend-count`},n.objects.count(a.length))),...(t.has(r)?[]:a.sort((e,t)=>e.id-t.id)).map(t=>wg(t,e.get()))]})}function wg(e,t){let r=e.placements[0],a=Ym(e.id,t),o=r?.template===`cells`?n.objects.ownCells:r&&n.objects.fit(r.iou);return c(`li`,{role:`treeitem`,class:`tree-leaf`,tabindex:`-1`,"aria-level":`2`,"aria-selected":String(t.selectedObjects.has(e.id)),data:{object:String(e.id),key:`o${e.id}`}},c(`span`,{class:`tree-word`},i(e)),a&&c(`span`,{class:`tree-clash`,role:`img`,"aria-label":a,title:a},Cd(`warn`)),c(`span`,{class:`legend-count`,title:n.objects.iou},o||`–`))}function Tg(e,t,n){e.selection.objects([t],Op(n));let r=e.store.get().objects.get(t);r&&n.detail===2&&e.view.focus(Om(r))}function Eg(e,t){e.delete(t)||e.add(t)}function Dg(e,t){let n=kg(e),r=n.find(e=>e.dataset.key===t)??n.find(e=>e.getAttribute(`aria-selected`)===`true`)??n[0];for(let e of n)e.tabIndex=e===r?0:-1;t&&r!==document.activeElement&&r?.dataset.key===t&&r.focus()}function Og(e,t){let n=kg(t),r=n.indexOf(document.activeElement),i=n[r],{key:a}=e;if(!i)return;let o={ArrowDown:r+1,ArrowUp:r-1,Home:0,End:n.length-1},s=i.getAttribute(`aria-expanded`);if(a in o)n[o[a]??0]?.focus();else if(a===`Enter`||a===` `)i.click();else if(a===`ArrowLeft`&&s===`true`||a===`ArrowRight`&&s===`false`)i.click();else return;e.preventDefault(),e.stopPropagation()}function kg(e){return[...e.querySelectorAll(`[role=treeitem]`)]}var Ag=[`off`,`x`,`y`,`z`];function jg(e,t){let{store:r}=t,i=g(n.slices.axis,()=>Ag.map(e=>({value:e,label:e===`off`?n.slices.off:e.toUpperCase()})),e=>r.setView({slice:Ig(r.get(),e)})),[a,o]=[Mg(t,`low`),Mg(t,`high`)],s=c(`div`,{class:`stack slice-fields`},a.node,o.node),l=_(n.slices.section,`section`,e=>r.setView({section:e?Lg(r.get()):null})),d=c(`div`,{class:`stack section-fields`}),f=v(n.slices.toSelection,()=>Rg(t),`button is-wide`);e.append(i.node,s,c(`h3`,{class:`sub`},n.slices.sectionTitle),l.node,d,f);let p=[];r.watch([`view`,`scene`],e=>{let{view:n,scene:r}=e;i.set(n.slice?Ag[n.slice.axis+1]??`off`:`off`),s.hidden=!n.slice,l.set(n.section!==null),n.slice&&r&&Ng(n.slice,r.shape,a,o),!!n.section!=p.length>0&&(p=n.section&&r?Pg(t,r.shape):[],u(d,...p.map(e=>e.node))),p.forEach((e,t)=>e.set(Fg(n.section,t)))})}function Mg({store:e},t){return h({label:n.slices[t],id:`slice-${t}`,min:0,max:1,step:1,show:String,change:n=>{let{slice:r}=e.get().view;if(!r)return;let i={...r,[t]:n};i.low>i.high&&(i[t===`low`?`high`:`low`]=n),e.setView({slice:i})}})}function Ng(e,t,n,r){for(let i of[n,r])i.input.max=String((t[e.axis]??1)-1);n.set(e.low),r.set(e.high)}function Pg({store:e},t){return[0,1,2,3,4,5].map(r=>{let[i,a]=[r>>1,r%2?`high`:`low`];return h({label:n.slices.side(`xyz`[i]??``,a),id:`section-${`xyz`[i]}-${a}`,min:0,max:(t[i]??1)-1,step:1,show:String,change:t=>{let{section:n}=e.get().view;if(!n)return;let r={low:[...n.low],high:[...n.high]};r[a][i]=t,r.low[i]>r.high[i]&&(r[a===`low`?`high`:`low`][i]=t),e.setView({section:r})}})})}function Fg(e,t){return e?.[t%2?`high`:`low`][t>>1]??0}function Ig({scene:e},t){let n=Ag.indexOf(t)-1;if(n<0||!e)return null;let r=(e.shape[n]??1)-1;return{axis:n,low:0,high:Math.round(r/2)}}function Lg({scene:e}){return{low:[0,0,0],high:(e?.shape??[1,1,1]).map(e=>e-1)}}function Rg({store:e,toast:t}){let{scene:r,instance:i,selectedCells:a,selectedObjects:o}=e.get();if(!r)return;let s=new Set(a);o.size&&i.forEach((e,t)=>o.has(e)&&s.add(t));let c=Xp(s,r.shape);c?e.setView({section:c}):t(n.why.nothingSelected,`error`)}function zg({store:e},t){let n=e.get(),r=n.view.slice??Ig(n,`z`),i=(n.scene?.shape[r?.axis??2]??1)-1;if(!r)return;let a=Math.min(i,Math.max(0,r.high+t)),o=r.low===0?0:Math.min(i,Math.max(0,r.low+t));e.setView({slice:{...r,low:Math.min(o,a),high:a}})}var Bg=15;function Vg(e){let{actions:t,store:r,selection:i}=e,a=()=>r.get().mode===`objects`;t.on(`delete`,{run:()=>{let t=hg(e).map(({id:e})=>e);a()||r.get().mode===`inspect`?e.do({op:`delete_objects`,ids:t}):Hg(e)},why:()=>Dp(r)||(r.get().mode===`voxels`?r.get().selectedCells.size?``:n.why.noCells:hg(e).length?``:n.why.noObject)});let o=()=>a()&&!r.get().objects.size?n.why.noObjects(``):``;t.on(`select.all`,{run:()=>{a()?i.objects(r.get().objects.keys()):i.cells(eh(e))},why:o}),t.on(`select.none`,{run:()=>i.clear(),why:()=>r.get().selectedCells.size+r.get().selectedObjects.size?``:n.why.nothingSelected}),t.on(`select.invert`,{run:()=>{let{objects:t,selectedObjects:n,selectedCells:o}=r.get();a()?i.objects([...t.keys()].filter(e=>!n.has(e))):i.cells(eh(e).filter(e=>!o.has(e)))},why:o}),t.on(`select.undo`,{run:()=>i.undo(),why:()=>i.canUndo?``:n.why.noSelectionBefore}),t.on(`select.redo`,{run:()=>i.redo(),why:()=>i.canRedo?``:n.why.noSelectionAfter})}function Hg({store:e,do:t}){let{selectedCells:n,view:r}=e.get();t({op:`set_cells`,cells:Gp(n),class_id:0,verb:`delete`,locked:[...r.locked]})}function Ug({actions:e,store:t}){let r=()=>t.get().options.size;e.on(`brush.smaller`,{run:()=>t.setOptions({size:r()-1}),why:()=>r()>1?``:n.why.smallest}),e.on(`brush.larger`,{run:()=>t.setOptions({size:r()+1}),why:()=>r()<Bg?``:n.why.largest}),e.on(`brush.shape`,()=>{let e=[`sphere`,`cube`,`single`],n=e.indexOf(t.get().options.shape);t.setOptions({shape:e[(n+1)%3]??`sphere`})}),e.on(`surface`,()=>t.setOptions({surfaceOnly:!t.get().options.surfaceOnly}));for(let n=0;n<12;n++)e.on(`class.${n}`,()=>t.setOptions({classId:n}))}var Wg=5;function Gg(e,t){let{actions:r,store:i}=t,a=v(``,()=>void t.do({op:`smooth`,class_id:i.get().options.classId})),o=r.button(`cells.smooth`,{label:n.smoothing.all});e.append(c(`div`,{class:`stack`},c(`p`,{class:`note`},n.smoothing.note),c(`div`,{class:`row is-even`},a,o))),i.watch([`options`,`selectedCells`,`scene`,`online`],({options:e,selectedCells:t})=>{let r=n.classes[e.classId]??``;a.textContent=n.smoothing.only(r),p(a,Dp(i)||(e.classId<Wg?n.why.notAnObject:``),n.smoothing.only(r));let s=o.querySelector(`span`);s&&(s.textContent=t.size?n.smoothing.selection:n.smoothing.all)})}function Kg(e){let{actions:t,store:r,view:i}=e,a=()=>r.get().scene?``:n.why.noScene,o=(e,n)=>t.on(e,{run:n,why:a});o(`view.reset`,()=>i.frame()),o(`view.focus`,()=>Zg(e)),o(`view.top`,()=>i.lookAlong(2)),o(`view.front`,()=>i.lookAlong(1)),o(`view.side`,()=>i.lookAlong(0)),t.on(`view.ortho`,{run:()=>i.orbit={...i.orbit,ortho:!i.orbit.ortho},why:a}),Yg(i,o),t.on(`view.unhide`,{run:()=>r.setView({hidden:new Set,solo:null}),why:()=>a()||(r.get().view.hidden.size||r.get().view.solo!==null?``:n.why.allShown)});let s=()=>a()||(Xg(e)?``:n.why.aClass);t.on(`view.hide`,{run:()=>Bh(e,Xg(e),!1),why:s}),t.on(`view.solo`,{run:()=>Bh(e,Xg(e),!0),why:s}),t.on(`view.edges`,{run:()=>r.setView({edges:!r.get().view.edges}),why:a,active:()=>r.get().view.edges}),o(`slice.up`,()=>zg(e,1)),o(`slice.down`,()=>zg(e,-1))}var qg=Math.PI/12,Jg=.12;function Yg(e,t){t(`camera.left`,()=>e.turn(-qg,0)),t(`camera.right`,()=>e.turn(qg,0)),t(`camera.up`,()=>e.turn(0,qg)),t(`camera.down`,()=>e.turn(0,-qg)),t(`camera.panLeft`,()=>e.pan(Jg,0)),t(`camera.panRight`,()=>e.pan(-.12,0)),t(`camera.panUp`,()=>e.pan(0,-.12)),t(`camera.panDown`,()=>e.pan(0,Jg)),t(`camera.closer`,()=>e.zoom(1/1.25)),t(`camera.away`,()=>e.zoom(1.25))}function Xg(e){let{selectedCells:t,labels:n,options:r}=e.store.get(),[i]=t;return hg(e)[0]?.class_id??(i===void 0?r.classId:n[i]??0)}function Zg(e){let t=hg(e).map(Om),{selectedCells:n}=e.store.get();if(t.length){let n=(e,n)=>[0,1,2].map(r=>e(...t.map(e=>e[n][r])));e.view.focus({low:n(Math.min,`low`),high:n(Math.max,`high`)})}else n.size?ph(e,[...n]):e.view.frame()}var Qg=new Set([`move`,`add`,`brush`,`erase`]);function $g(){let{titles:e}=n.panels,t={place:`right`};T({id:`legend`,title:e.legend,place:`left`,modes:`all`,order:10,mount:Fh}),T({id:`objects`,title:e.objects,place:`left`,modes:[`inspect`,`objects`,`build`],order:20,mount:Sg}),T({...t,id:`inspector`,title:e.inspector,modes:[`inspect`,`objects`],order:10,mount:rg}),T({...t,id:`cells`,title:e.cells,modes:[`voxels`],order:10,mount:Xm}),T({...t,id:`floaters`,title:e.floaters,modes:[`voxels`],order:20,mount:dh}),T({...t,id:`holes`,title:e.holes,modes:[`voxels`],order:30,mount:eg}),T({...t,id:`smoothing`,title:e.smoothing,modes:[`voxels`],order:40,closed:!0,mount:Gg}),T({...t,id:`doubtful`,title:e.doubtful,modes:[`inspect`,`objects`],order:40,closed:!0,mount:Yh}),T({...t,id:`recluster`,title:e.recluster,modes:[`objects`],order:50,closed:!0,mount:Th}),T({...t,id:`slices`,title:e.slices,modes:[`inspect`,`voxels`,`objects`,`build`],order:80,closed:!0,mount:jg}),T({...t,id:`display`,title:e.display,modes:[`inspect`,`voxels`,`objects`],order:90,mount:Kh})}function e_(e,t){let n=new vm(e,{hover:t,rightClick:(t,n)=>Uh(e,t,n)}),{desk:r}=n,i=[Vm(r),$p(r,`brush`),$p(r,`erase`),Lp(r),Bp(r),pm(r),um(r),bm(r),Nm(r),Pp(r)];for(let t of i)n.add(t),e.actions.on(`tool.${t.id}`,{run:()=>e.store.set({tool:t.id}),why:()=>Qg.has(t.id)?Dp(e.store):``,active:()=>e.store.get().tool===t.id});return Gm(e),Kg(e),gg(e),Qm(e),Lm(r),cm(e),Vg(e),Ug(e),e.store.watch([`mode`],({tool:t})=>{t!==`navigate`&&e.store.set({tool:`navigate`})}),n}function t_(e){let t=c(`canvas`,{class:`canvas`,tabindex:`0`,"aria-label":n.stage.label}),r=c(`div`,{class:`rail`,role:`toolbar`,"aria-label":n.stage.tools});r.setAttribute(`aria-orientation`,`vertical`);let i=c(`div`,{class:`tool-options`,role:`toolbar`,"aria-label":n.stage.options}),a=c(`div`,{class:`corner`,role:`toolbar`,"aria-label":n.stage.ways}),o=c(`div`,{class:`over`}),s=c(`div`,{class:`toasts`,role:`log`,"aria-live":`polite`}),l=c(`main`,{class:`stage`},t,o,r,i,a,s),u=c(`header`,{class:`top`}),d=c(`aside`,{class:`side left`,"aria-label":n.panels.left}),f=c(`aside`,{class:`side right`,"aria-label":n.panels.right}),p=c(`section`,{class:`drawer`,"aria-label":n.panels.drawer}),m=c(`footer`,{class:`status`,"aria-label":n.status.label}),h=c(`div`,{class:`window`},u,d,l,f,p,m);return e.replaceChildren(h),{root:h,top:u,left:d,right:f,stage:l,canvas:t,rail:r,options:i,corner:a,over:o,toasts:s,drawer:p,status:m}}function n_(e){let t=c(`button`,{type:`button`,class:`button icon-only`,"aria-label":n.help.close});t.append(Cd(`close`)),t.title=n.help.close;let r=up.map(e=>r_(e,yp.filter(t=>t.group===e&&t.keys.length))),i=c(`section`,{class:`sheet help`,role:`region`,"aria-label":n.help.title,tabindex:`-1`},c(`div`,{class:`sheet-head`},c(`h2`,{},n.help.title),c(`span`,{class:`note`},n.help.note),t),c(`div`,{class:`help-groups`},...r.filter(e=>e!==null)));i.hidden=!0,e.stage.append(i);let a=null,o=()=>!i.hidden&&(i.hidden=!0,(a??e.canvas).focus(),!0);return t.addEventListener(`click`,o),e.actions.on(`help`,()=>{o()||(a=document.activeElement,i.hidden=!1,i.focus())}),{close:o}}function r_(e,t){if(!t.length)return null;let r=t.flatMap(t=>[c(`dt`,{},...t.keys.map(e=>c(`kbd`,{class:`key`},o_(e)))),c(`dd`,{},t.title,t.modes&&t.modes.length<3&&!i_.has(e)&&c(`span`,{class:`note`},` ${t.modes.map(e=>n.action[`mode.${e}`]).join(`, `)}`))]);return c(`section`,{class:`help-group`},c(`h3`,{},n.groups[e]),c(`dl`,{},...r))}var i_=new Set([`voxels`,`objects`,`selection`,`classes`]),a_={Escape:`Esc`,ArrowRight:`→`,ArrowLeft:`←`,ArrowUp:`↑`,ArrowDown:`↓`,PageUp:`Page up`,PageDown:`Page down`};function o_(e){return e.split(`+`).map(e=>a_[e]??e.replace(/^Numpad/,`Numpad `)).join(`+`)}var s_=new Set([`undo`,`redo`,`delete`,`select.all`]);function c_(e,t){window.addEventListener(`keydown`,n=>{if(n.defaultPrevented)return;let r=xp(n,e.get().mode);if(!r||!t.has(r.id))return;let i=n.ctrlKey||n.metaKey||n.key===`Escape`||n.key===`F1`;m(n.target)&&(!i||s_.has(r.id))||l_(n)||(n.preventDefault(),t.run(r.id))})}function l_(e){let t=e.target;return!(t instanceof HTMLElement)||t instanceof HTMLCanvasElement?!1:e.key===` `?t.closest(`button, a, input, select, summary, [role=treeitem], [role=tab]`)!==null:e.key===`Enter`?t.closest(`button, a, select, summary, [role=treeitem]`)!==null:e.key.startsWith(`Page`)?t.closest(`input, select`)!==null:e.key.startsWith(`Arrow`)?t.closest(`input, select, [role=treeitem], [role=tablist]`)!==null:t instanceof HTMLSelectElement&&e.key.length===1&&!e.ctrlKey}function u_(e){let t=gh({label:n.action.export,class:`button is-main`,id:`export`},()=>[{label:n.action.save,hint:`Ctrl+S`,why:e.actions.why(`save`),run:()=>e.actions.run(`save`)},...k.exports().map(t=>({label:t.label,hint:t.hint,why:t.why?.(e)??``,run:()=>t.run(e)}))]);return t.prepend(Cd(`export`)),e.actions.on(`export`,{run:()=>t.click(),why:()=>e.store.get().scene?``:n.why.noScene}),t}var d_=[`inspect`,`voxels`,`objects`,`build`,`walk`];function f_(e,t){let{actions:r,store:i}=t,a=c(`h1`,{class:`scene-name`}),o=c(`span`,{class:`saved`}),s=r.button(`undo`,{icon:`undo`}),l=r.button(`redo`,{icon:`redo`});e.append(c(`div`,{class:`top-scene`},r.button(`start`,{icon:`back`}),c(`span`,{class:`brand`,"aria-hidden":`true`}),a,o,c(`div`,{class:`top-history`},s,l,r.button(`save`,{icon:`save`}))),m_(t),c(`div`,{class:`top-page`},r.button(`palette`,{icon:`search`}),r.button(`theme`,{icon:`sun`}),r.button(`help`,{icon:`help`}),u_(t))),i.watch([`scene`,`online`],e=>{a.textContent=e.scene?.name??n.app,a.title=e.scene?.name??``,p_(o,e),document.title=e.scene?`${e.scene.name} · ${n.app}`:n.app})}function p_(e,{scene:t,online:r}){e.className=`saved`,e.title=``,r?t?.read_only?(e.title=t.read_only,u(e,n.top.readOnly)):t&&!t.saved?(e.classList.add(`is-unsaved`),e.title=n.top.unsavedHint,u(e,n.top.unsaved)):u(e,t?n.top.saved:``):(e.classList.add(`is-bad`),u(e,n.top.offline))}function m_({actions:e,store:t}){let r=d_.map((t,r)=>{let i=e.button(`mode.${t}`,{label:n.action[`mode.${t}`],class:`mode-tab`});return i.setAttribute(`role`,`tab`),i.removeAttribute(`aria-label`),i.prepend(c(`kbd`,{"aria-hidden":`true`},`⇧${r+1}`)),i}),i=c(`div`,{class:`mode-tabs`,role:`tablist`,"aria-label":n.top.modes},...r);return Fd(i),t.watch([`mode`],({mode:e})=>{r.forEach((t,n)=>t.setAttribute(`aria-selected`,String(d_[n]===e)))}),i}function h_(e){let t=c(`input`,{type:`text`,role:`combobox`,placeholder:n.palette.placeholder,"aria-label":n.palette.title,"aria-expanded":`true`,"aria-controls":`palette-list`,autocomplete:`off`,spellcheck:`false`}),r=c(`ul`,{id:`palette-list`,role:`listbox`,"aria-label":n.palette.title}),i=c(`section`,{class:`palette`,"aria-label":n.palette.title},t,r);i.hidden=!0,e.stage.parentElement?.append(i);let a=null,o=[],s=0,l=()=>{o=v_(g_(e),t.value),s=Math.max(0,Math.min(s,o.length-1)),u(r,...o.map((e,t)=>y_(e,t===s,()=>f(t)))),o.length||r.append(c(`li`,{class:`note palette-none`},n.palette.none));let i=r.children[s];i?.scrollIntoView({block:`nearest`}),t.setAttribute(`aria-activedescendant`,i?.id??``)},d=()=>!i.hidden&&(i.hidden=!0,(a??e.canvas).focus(),!0),f=t=>{let n=o[t];n&&(d(),n.why?e.toast(n.why,`error`):e.actions.run(n.id))};return t.addEventListener(`input`,()=>{s=0,l()}),t.addEventListener(`keydown`,e=>{let t={ArrowDown:1,ArrowUp:-1}[e.key];if(e.key===`Enter`)f(s);else if(e.key===`Escape`)d();else if(t&&o.length)s=(s+t+o.length)%o.length,l();else return;e.preventDefault(),e.stopPropagation()}),i.addEventListener(`focusout`,e=>{i.contains(e.relatedTarget)||(i.hidden=!0)}),e.actions.on(`palette`,()=>{d()||(a=document.activeElement,i.hidden=!1,t.value=``,s=0,l(),t.focus())}),{close:d}}function g_({actions:e,store:t}){let r=t.get();return e.list().filter(({binding:e})=>e.id!==`palette`&&e.id!==`cancel`).map(({binding:e,why:t})=>({id:e.id,title:e.title,group:n.groups[e.group],keys:e.keys.map(o_)[0]??``,why:__(e,r)||t}))}function __({id:e,modes:t},{mode:r,tool:i,options:a}){let o=e=>e.map(e=>n.action[`mode.${e}`]).join(`, `);if(t&&!t.includes(r)){let e=d_.filter(e=>!t.includes(e));return e.length>1?n.why.onlyIn(o(t)):n.why.elsewhere(o(e))}return[`mode.${r}`,`tool.${i}`,`class.${a.classId}`].includes(e)?n.why.chosen:``}function v_(e,t){let n=t.toLowerCase().split(/\s+/).filter(Boolean),r=e.filter(({title:e,group:t})=>n.every(n=>`${e} ${t}`.toLowerCase().includes(n))),i=({title:e})=>+!e.toLowerCase().startsWith(n[0]??``),a=e=>2*i(e)+ +!!e.why;return r.sort((e,t)=>a(e)-a(t))}function y_(e,t,n){let r=c(`li`,{role:`option`,id:`palette-${e.id}`,class:`palette-row`,"aria-selected":String(t),data:{action:e.id}},c(`span`,{class:`palette-title`},e.title),c(`span`,{class:`note palette-group`},e.why||e.group),e.keys&&c(`kbd`,{class:`key`},e.keys));return e.why&&r.setAttribute(`aria-disabled`,`true`),r.addEventListener(`pointerdown`,e=>{e.preventDefault(),n()}),r}var b_=500;function x_(e,t){let r=[`cell`,`metres`,`class`,`object`].map(e=>c(`span`,{class:`status-${e}`,data:{status:e}})),i=c(`span`,{class:`status-said`,role:`status`,data:{status:`said`}}),a=c(`span`,{class:`status-speed`,data:{status:`speed`}});return e.append(...r,i,a),t.store.watch([`status`],({status:e})=>{i.textContent=e,i.title=e}),S_(a,t),r[0].textContent=n.status.none,{show:e=>r.forEach((n,r)=>n.textContent=C_(t.store,e)[r]??``)}}function S_(e,t){let r=0,i=0;t.view.onFrame.push(a=>{let o=performance.now();!(t.view.controls.dragging||t.store.get().mode===`walk`)||o-r<b_||(r=o,e.textContent=n.status.frame(a),clearTimeout(i),i=window.setTimeout(()=>e.textContent=``,4*b_))})}function C_(e,{cell:t,flat:r}){let{scene:i,labels:a,instance:o,objects:s}=e.get();if(!t||!i)return[n.status.none,``,``,``];let c=t.map((e,t)=>((i.origin_m[t]??0)+(e+.5)*i.voxel_m).toFixed(2)),l=o[r]??0;return[n.status.cell(t.join(`, `)),n.status.metres(c.join(`, `)),n.classes[a[r]??255]??n.status.unseen,l?n.status.object(l,s.get(l)?.title):``]}var w_=`sceneforge.theme`;function T_(e){let t=matchMedia(`(prefers-color-scheme: light)`).matches,n=localStorage.getItem(w_);e.set({theme:n===`light`||n===`dark`?n:t?`light`:`dark`}),e.watch([`theme`],({theme:e})=>{document.documentElement.dataset.theme=e})}function E_(e){let t=e.get().theme===`dark`?`light`:`dark`;localStorage.setItem(w_,t),e.set({theme:t})}var D_={brush:e=>k_(j_(e),M_(e),N_(e)),erase:e=>k_(M_(e)),box:e=>k_(P_(e),A_(n.tools.combine)),lasso:e=>k_(P_(e),A_(n.tools.combine)),flood:()=>k_(A_(n.tools.flood),A_(n.tools.combine)),eyedropper:()=>k_(A_(n.tools.eyedropper)),measure:()=>k_(A_(n.tools.measure)),add:e=>k_(j_(e),A_(n.tools.add)),move:()=>k_(A_(n.tools.move))};function O_(e,t){let n=``,r=null;t.store.watch([`tool`,`options`,`mode`,`scene`],i=>{i.tool!==n&&(n=i.tool,r=D_[i.tool]?.(t)??null,u(e,...r?.nodes??[])),e.hidden=!r||i.mode===`walk`,r?.show(i)})}function k_(...e){return{nodes:e.flatMap(e=>e.nodes),show:t=>e.forEach(e=>e.show(t))}}function A_(e){return{nodes:[c(`span`,{class:`note`},e)],show:()=>void 0}}function j_(e){let t=c(`span`,{class:`swatch`}),r=c(`span`,{}),i=c(`button`,{type:`button`,class:`button`,"aria-haspopup":`menu`,data:{picker:`class`}},t,r,Cd(`down`));return i.addEventListener(`click`,()=>{let t=i.getBoundingClientRect();_h((e.store.get().scene?.classes??[]).filter(({id:e})=>e>0).map(({id:t,colour:r})=>({label:n.classes[t]??``,swatch:`rgb(${r.join(` `)})`,run:()=>e.store.setOptions({classId:t})})),t.left,t.bottom+4,i)}),{nodes:[i],show:({scene:e,options:a})=>{let o=e?.classes[a.classId]?.colour??[128,128,128];t.style.setProperty(`--swatch`,`rgb(${o.join(` `)})`),r.textContent=n.classes[a.classId]??``,i.title=n.tools.paints(n.classes[a.classId]??``)}}}function M_({store:e}){let t=[`sphere`,`cube`,`single`],r=g(n.tools.shape,()=>t.map(e=>({value:e,label:n.tools.shapes[e]})),t=>e.setOptions({shape:t})),i=h({label:n.tools.size,id:`brush-size`,min:1,max:15,step:1,show:String,change:t=>e.setOptions({size:t})});return i.node.classList.add(`is-compact`),{nodes:[r.node,i.node],show:({options:e})=>{r.set(e.shape),i.set(e.size),i.node.hidden=e.shape===`single`}}}function N_({store:e}){let t=[`empty`,`occupied`,`all`],r=g(n.tools.fills,()=>t.map(e=>({value:e,label:n.tools.fillsWords[e]})),t=>e.setOptions({fills:t}));return{nodes:[r.node],show:({options:e})=>r.set(e.fills)}}function P_({store:e}){let t=_(n.tools.surface,`surface`,t=>e.setOptions({surfaceOnly:t})),r=h({label:n.tools.depth,id:`depth`,min:0,max:40,step:1,show:e=>e?n.cells(e):n.tools.through,change:t=>e.setOptions({depth:t})});return r.node.classList.add(`is-compact`),{nodes:[t.node,r.node],show:({options:e})=>{t.set(e.surfaceOnly),r.set(e.depth),r.node.hidden=e.surfaceOnly}}}var F_=[[`tool.navigate`,`navigate`]],I_=[`tool.measure`,`measure`],L_={inspect:[...F_,I_],voxels:[...F_,[`tool.brush`,`brush`],[`tool.erase`,`erase`],[`tool.box`,`box`],[`tool.lasso`,`lasso`],[`tool.flood`,`flood`],[`tool.eyedropper`,`eyedropper`],I_],objects:[...F_,[`tool.move`,`move`],[`tool.add`,`add`],I_,null,[`object.turnBack`,`turnBack`],[`object.turn`,`turn`],[`object.split`,`split`],[`object.merge`,`merge`],[`object.duplicate`,`duplicate`],[`object.floor`,`floor`],[`object.wall`,`wall`],[`delete`,`trash`]],build:[...F_,I_],walk:[]};function R_(e,{actions:t,store:n}){let r=null;n.watch([`mode`],({mode:n})=>{n!==r&&(r=n,e.replaceChildren(...L_[n].map(e=>e?t.button(e[0],{icon:e[1],class:`button icon-only tool`}):c(`hr`,{class:`rail-line`}))))}),Fd(e)}function z_(e,{actions:t}){e.append(t.button(`view.reset`,{icon:`home`}),t.button(`view.focus`,{icon:`focus`}),t.button(`view.top`,{icon:`viewTop`}),t.button(`view.front`,{icon:`viewFront`}),t.button(`view.side`,{icon:`viewSide`}),t.button(`view.ortho`,{icon:`ortho`})),Fd(e)}var B_={info:3500,error:7e3},V_=3;function H_(e){return(t,n=`info`)=>{let r=c(`div`,{class:`toast is-${n}`},t);for(let n of e.children)n.textContent===t&&n.remove();for(e.append(r);e.children.length>V_;)e.firstElementChild?.remove();setTimeout(()=>r.remove(),B_[n])}}async function U_(e,t,n){T_(t);let r=t_(e),i=H_(r.toasts),a=new sp(t),o=new Tp(t,e=>i(e,`error`)),s=n(r.canvas,t),l=e=>{let n=e instanceof Error?e.message:String(e);return t.set({status:n}),i(n,`error`),null},u={store:t,view:s,connection:a,actions:o,selection:new Ap(t),pointer:{at:null},stage:r.stage,canvas:r.canvas,toast:i,do:e=>a.do(e).catch(l),ask:(e,t={})=>a.ask(e,t).catch(l)};K_(u,l);let d=x_(r.status,u),f=e_(u,e=>{let t=e&&s.pick(e.x,e.y);d.show({cell:t?t.cell:null,flat:t?t.flat:-1})});f_(r.top,u),R_(r.rail,u),z_(r.corner,u),O_(r.options,u),rh(r.left,`left`,u),rh(r.right,`right`,u);let p=[h_(u),n_(u)];o.on(`cancel`,()=>{vh()||p.some(e=>e.close())||f.cancel()||(t.get().tool===`navigate`?u.selection.clear():t.set({tool:`navigate`}))});for(let e of k.stageParts()){let t=c(`div`,{class:`over-part`,data:{part:e.id}});r.over.append(t),e.mount(t,u)}oh(r.drawer,u),c_(t,o);for(let e of[`pointerdown`,`keydown`,`wheel`])addEventListener(e,()=>a.active(),{passive:!0});return q_(u),G_(u),await W_(u,r.root),u}async function W_(e,t){let r=c(`div`,{class:`start-page`}),i=k.startPage(),a=!1;e.store.watch([`scene`],({scene:n})=>{let o=a&&!n&&i!==null;o&&!r.hasChildNodes()&&i?.(r,e),o?t.append(r):r.remove(),t.classList.toggle(`is-start`,o)});try{await e.connection.open()}catch(t){t instanceof ap||e.toast(t instanceof Error?t.message:n.error.load,`error`)}a=!0,e.store.get().scene||e.store.set({scene:null})}function G_({store:e,toast:t}){let n=new Set,r=0;e.watch([`scene`],({scene:e})=>{e&&e.document!==r&&(n=new Set),r=e?.document??0;for(let r of e?.notes??[])n.has(r)||t(r,`error`);for(let t of e?.notes??[])n.add(t)})}function K_({actions:e,store:t,connection:r,toast:i},a){let o=()=>Dp(t);e.on(`undo`,{run:()=>void r.undo().catch(a),why:()=>o()||(t.get().scene?.undo?``:n.why.nothingToUndo),title:()=>n.top.undo(t.get().scene?.undo??``)}),e.on(`redo`,{run:()=>void r.redo().catch(a),why:()=>o()||(t.get().scene?.redo?``:n.why.nothingToRedo),title:()=>n.top.redo(t.get().scene?.redo??``)}),e.on(`save`,{run:()=>void r.save().then(()=>i(n.top.saved),a),why:o}),e.on(`theme`,()=>E_(t)),e.on(`start`,{run:()=>void Zu(`api/start/close`).catch(a),why:()=>t.get().scene?``:n.why.noScene});for(let r of d_)e.on(`mode.${r}`,{run:()=>t.set({mode:r}),why:()=>t.get().scene?``:n.why.noScene})}function q_(e){let t=null;e.store.watch([`mode`],({mode:n})=>{if(n!==t){if(t)for(let n of k.hooks(t))n.leave?.(e);t=n,document.body.dataset.mode=n,e.store.set({status:``});for(let t of k.hooks(n))t.enter?.(e)}})}var J_=`sceneforge.hints`;function Y_(){E({id:`hints`,mount:X_})}function X_(e,t){if(localStorage.getItem(J_)===`seen`)return;let r=c(`button`,{type:`button`,class:`button icon-only`,"aria-label":n.hints.close});r.append(Cd(`close`)),r.title=n.hints.close;let i=n.hints.list.map(([e,t])=>c(`li`,{},c(`kbd`,{class:`key`},e),c(`span`,{},t))),a=c(`section`,{class:`hints`,"aria-label":n.hints.title},c(`ul`,{},...i),r);r.addEventListener(`click`,()=>{localStorage.setItem(J_,`seen`),a.remove(),t.canvas.focus()});let o=t.store.watch([`scene`,`mode`],({scene:t,mode:n})=>{t&&!a.parentElement&&n!==`walk`&&(e.append(a),queueMicrotask(()=>o()))})}function Z_(e,t,n,r){return(t*e[1]+n)*e[2]+r}function Q_(e,t){let n=t%e[2],r=(t-n)/e[2],i=r%e[1];return[(r-i)/e[1],i,n]}function $_(e){return e!==0&&e!==255}function ev(e,t){let n=[],r=t.byteOffset%4==0&&e.byteOffset%4==0?t.length>>2:0,[i,a]=[e,t].map(e=>new Uint32Array(e.buffer,r&&e.byteOffset,r)),o=(r,i)=>{for(let a=r;a<i;a++)e[a]!==t[a]&&(n.push(a),e[a]=t[a])};for(let e=0;e<r;e++)i[e]!==a[e]&&o(4*e,4*e+4);return o(4*r,t.length),n}var tv=34,nv=[1156,tv,1],rv=8,iv=new Uint32Array(65536),av=0,ov=new Uint8Array(1156*tv),sv=new Uint8Array(1024);function cv(e,t,n,r=1,i=`greedy`){av=0;let a=32/r;if(!(r===1?lv(e,t,n):uv(e,t,n,r)))return{words:new Uint32Array,starts:[0,0,0,0,0,0,0]};let o=[],s=i===`cubes`?vv(a):null;for(let e=0;e<6;e++)o.push(av/rv),s?yv(s,e):fv(e,a,r);return o.push(av/rv),{words:iv.slice(0,av),starts:o}}function lv(e,[t,n,r],[i,a,o]){ov.fill(0);let s=0,c=Math.max(o-1,0),l=Math.min(o+32+1,r);for(let u=Math.max(i-1,0);u<Math.min(i+32+1,t);u++)for(let t=Math.max(a-1,0);t<Math.min(a+32+1,n);t++){let d=(u*n+t)*r,f=(u-i+1)*nv[0]+(t-a+1)*tv-o+1;for(let t=c;t<l;t++){let n=e[d+t];n!==255&&(ov[f+t]=n,s|=n)}}return s!==0}function uv(e,t,n,r){ov.fill(0);let i=new Uint16Array(256),a=32/r,o=!1;for(let s=0;s<a;s++)for(let c=0;c<a;c++)for(let l=0;l<a;l++){let a=dv(e,t,[n[0]+s*r,n[1]+c*r,n[2]+l*r],r,i);a&&(ov[(s+1)*nv[0]+(c+1)*tv+l+1]=a,o=!0)}return o}function dv(e,[t,n,r],[i,a,o],s,c){c.fill(0,0,16);let l=0;for(let u=i;u<Math.min(i+s,t);u++)for(let t=a;t<Math.min(a+s,n);t++){let i=(u*n+t)*r;for(let t=o;t<Math.min(o+s,r);t++){let n=e[i+t];n!==0&&n!==255&&(c[n]+=1,(l===0||c[n]>c[l])&&(l=n))}}return l}function fv(e,t,n){let r=e%3,i=(r+1)%3,a=(r+2)%3,o=e<3?nv[r]:-nv[r];for(let s=0;s<t;s++){if(!pv(s,r,i,a,o,t))continue;let c=s+ +(e<3);for(let r=0;r<t;r++)for(let o=0;o<t;){let s=sv[r*32+o];if(!s){o+=1;continue}let l=mv(o,r,s,t),u=hv(o,r,l,s,t);for(let e=r;e<r+u;e++)sv.fill(0,e*32+o,e*32+o+l);_v(e,c,i,a,o,r,l,u,s,n),o+=l}}}function pv(e,t,n,r,i,a){let o=0,s=(e+1)*nv[t]+nv[n]+nv[r];for(let e=0;e<a;e++){let t=s+e*nv[r];for(let r=0;r<a;r++,t+=nv[n]){let n=ov[t],a=n===ov[t+i]?0:n;sv[e*32+r]=a,o|=a}}return o!==0}function mv(e,t,n,r){let i=1;for(;e+i<r&&sv[t*32+e+i]===n;)i+=1;return i}function hv(e,t,n,r,i){let a=1;for(;t+a<i;a++){let i=(t+a)*32+e;for(let e=0;e<n;e++)if(sv[i+e]!==r)return a}return a}var gv=[0,8,16];function _v(e,t,n,r,i,a,o,s,c,l){bv(rv);let u=c|l<<8,d=t*l<<gv[e%3]|e<<24,f=i*l<<gv[n],p=(i+o)*l<<gv[n],m=a*l<<gv[r],h=(a+s)*l<<gv[r],[g,_]=[1<<27+n,1<<27+r],v=e<3?p|m|g:f|h|_,y=e<3?f|h|_:p|m|g;iv[av]=d|f|m,iv[av+2]=d|v,iv[av+4]=d|p|h|g|_,iv[av+6]=d|y;for(let e=1;e<rv;e+=2)iv[av+e]=u;av+=rv}function vv(e){let t=[];for(let n=1;n<=e;n++)for(let r=1;r<=e;r++)for(let i=1;i<=e;i++){let e=n*nv[0]+r*tv+i,a=ov[e];a&&nv.some(t=>ov[e+t]!==a||ov[e-t]!==a)&&t.push(e)}return Uint32Array.from(t)}function yv(e,t){let n=t%3,r=t<3?1<<n:0,i=1<<(n+1)%3,a=1<<(n+2)%3,o=t<3?[0,i,i|a,a]:[0,a,i|a,i];for(let n of e){bv(rv);let e=n%tv-1,i=Math.floor(n/tv)%tv-1,a=Math.floor(n/nv[0])-1;for(let s of o)iv[av++]=a|i<<8|e<<16|t<<24|(s|r)<<27,iv[av++]=ov[n]|256}}function bv(e){if(av+e<=iv.length)return;let t=new Uint32Array(iv.length*2);t.set(iv),iv=t}var xv=class{key;low;version;touched=!1;built=new Map;middle;constructor(e,t,n){this.key=e,this.low=t,this.version=n,this.middle=new G(t[0]+16,t[1]+16,t[2]+16)}isFresh(e,t){let n=this.built.get(e);return n!==void 0&&n.version===this.version&&n.style===t}best(e,t){let n=e===1?[1,2,4]:e===2?[2,1,4]:[4,2,1],r=n.find(e=>this.isFresh(e,t))??n.find(e=>this.built.has(e));return r===void 0?null:this.built.get(r)}show(e){for(let t of this.built.values())t.mesh&&(t.mesh.visible=t===e)}get quads(){let e=0;for(let{starts:t}of this.built.values())e+=t[6];return e}drop(e){let t=this.built.get(e)?.mesh;this.built.delete(e),t&&(t.removeFromParent(),t.geometry.setIndex(null),t.geometry.dispose())}};function Sv(e,{words:t},n,r){let i=new ei,a=new ti(new Uint8Array(t.buffer),8);i.setAttribute(`place`,new ii(a,4,0)),i.setAttribute(`kind`,new ii(a,4,4)),i.setIndex(n),i.boundingSphere=new Kr(new G(16,16,16),27.84);let o=new Oi(i,[r]);return o.position.set(...e),o.updateMatrix(),o.matrixAutoUpdate=!1,o}function Cv(e){let t=new Uint32Array(e*6);for(let n=0,r=0,i=0;n<e;n++,r+=6,i+=4)t[r]=t[r+3]=i,t[r+1]=i+1,t[r+2]=t[r+4]=i+2,t[r+5]=i+3;return new zr(t,1)}function wv(e,t){let n=[];for(let r=0;r<6;r++){let i=t[r]*6,a=t[r+1]*6-i;if(!e[r]||!a)continue;let o=n[n.length-1];o&&o.start+o.count===i?o.count+=a:n.push({start:i,count:a,materialIndex:0})}return n}function Tv(e,t,{low:n,high:r}){let i=[];if(n.some((e,t)=>e>=r[t]))return new Uint16Array;for(let a=0;a<3;a++)r[a]<t[a]&&Ev(i,e,t,n,r,a),n[a]>0&&Ev(i,e,t,n,r,a+3);return Uint16Array.from(i)}function Ev(e,t,n,r,i,a){let o=a%3,[s,c]=[(o+1)%3,(o+2)%3],l=[n[1]*n[2],n[2],1],u=a<3?i[o]-1:r[o],d=a<3?l[o]:-l[o],f=i[s]-r[s],p=new Uint8Array(f*(i[c]-r[c]));for(let e=r[c],n=0;e<i[c];e++)for(let a=r[s];a<i[s];a++,n++){let r=u*l[o]+a*l[s]+e*l[c],i=t[r];$_(i)&&t[r+d]===i&&i!==255&&(p[n]=i)}let m=u+ +(a<3);Dv(p,f,(t,n,i,l,u)=>{let d=(d,f)=>{let p=[0,0,0];p[o]=m,p[s]=r[s]+t+d*i,p[c]=r[c]+n+f*l,e.push(...p,a|d<<3+s|f<<3+c,u,1,0,0)};d(0,0),a<3?d(1,0):d(0,1),d(1,1),a<3?d(0,1):d(1,0)})}function Dv(e,t,n){let r=e.length/t;for(let i=0;i<r;i++)for(let a=0;a<t;a++){let o=e[i*t+a];if(!o)continue;let s=1;for(;a+s<t&&e[i*t+a+s]===o;)s+=1;let c=1,l=n=>{for(let r=0;r<s;r++)if(e[n*t+a+r]!==o)return!1;return!0};for(;i+c<r&&l(i+c);)c+=1;for(let n=i;n<i+c;n++)e.fill(0,n*t+a,n*t+a+s);n(a,i,s,c,o),a+=s-1}}var Ov=class{group;material;mesh=null;of=``;constructor(e,t){this.group=e,this.material=t}forget(){this.of=``}take(e,t,n,r){let i=[...n.low,...n.high,r].join();if(i===this.of)return;this.of=i,this.mesh?.removeFromParent(),this.mesh?.geometry.dispose(),this.mesh=null;let a=r?Tv(e,t,n):new Uint16Array;if(!a.length)return;let o=new ei,s=new ti(a,8);o.setAttribute(`place`,new ii(s,4,0)),o.setAttribute(`kind`,new ii(s,4,4)),o.setIndex(Cv(a.length/32)),this.mesh=new Oi(o,this.material.greedy),this.mesh.frustumCulled=!1,this.mesh.matrixAutoUpdate=!1,this.group.add(this.mesh),this.mesh.updateMatrixWorld(!0)}},kv=2,Av=3,jv=class{done;workers=[];queue=[];sent=new Set;volume=null;constructor(e){this.done=e}get open(){return this.queue.length+this.workers.reduce((e,{busy:t})=>e+t,0)}setVolume(e,t){this.volume={labels:e,shape:t};for(let e of this.workers)e.stale=!0}replace(e){this.queue=e.filter(e=>!this.sent.has(Mv(e))).reverse(),this.queue.length&&this.start(),this.feed()}dispose(){this.queue=[];for(let{worker:e}of this.workers)e.terminate();this.workers=[]}start(){for(;this.workers.length<kv;){let e=new Worker(new URL(new URL(`worker.js`,import.meta.url).href,``+import.meta.url),{type:`module`}),t={worker:e,busy:0,stale:!0};e.onmessage=({data:e})=>{--t.busy,this.sent.delete(Mv(e)),this.feed(),this.done(e)},this.workers.push(t)}}feed(){if(this.volume)for(let e=0;e<Av;e++)for(let t of this.workers){if(t.busy>e)continue;let n=this.queue.pop();if(!n)return;if(t.stale){let e={type:`load`,epoch:n.epoch,...this.volume};t.worker.postMessage(e),t.stale=!1}t.busy+=1,this.sent.add(Mv(n)),t.worker.postMessage({type:`mesh`,...n})}}};function Mv({key:e,epoch:t,step:n,style:r}){return`${e} ${t} ${n} ${r}`}var Nv=[{scale:2,coarse:0},{scale:1.5,coarse:0},{scale:1,coarse:0},{scale:.8,coarse:0},{scale:.65,coarse:1},{scale:.5,coarse:2},{scale:.4,coarse:3}],Pv=2,Fv=42,Iv=20,Lv=10,Rv=class{level=Pv;fast=0;get moving(){return Nv[this.level]}get still(){return{scale:this.level===0?2:this.level<Nv.length-2?1.5:1,coarse:0}}took(e){if(e>Fv){this.fast=0;let t=e>2.5*Fv?2:1;this.level=Math.min(this.level+t,Nv.length-1)}else e<Iv&&++this.fast>=Lv&&(this.fast=0,this.level=Math.max(this.level-1,0))}},zv=[1.1,2.5,6,12];function Bv(e,t){let n=zv[t]??zv[0];return e>=n?1:e>=n/2?2:4}var Vv=12,Hv=64,Uv=Math.log2(32),Wv=16*Math.sqrt(3),Gv=class{material;changed;group=new Qn;settled=!0;made=0;chunks=[];counts=[0,0,0];labels=new Uint8Array;shape=[0,0,0];style=`greedy`;stamp=0;index=Cv(4096);pool=new jv(e=>this.receive(e));constructor(e,t){this.material=e,this.changed=t,this.group.matrixAutoUpdate=!1}get quads(){return this.chunks.reduce((e,t)=>e+t.quads,0)}get bytes(){return this.quads*32+this.index.array.byteLength}load(e,t,n,r){this.clear(),this.labels=e,this.shape=t,this.group.matrix.makeScale(n,n,n).setPosition(...r),this.group.updateMatrixWorld(!0),this.counts=t.map(e=>Math.ceil(e/32));let[i,a,o]=this.counts;this.stamp+=1;for(let e=0;e<i*a*o;e++){let t=[Math.floor(e/(a*o)),Math.floor(e/o)%a,e%o];this.chunks.push(new xv(e,t.map(e=>e*32),this.stamp))}this.pool.setVolume(e,t)}touch(e){this.stamp+=1;for(let t of this.touchedBy(e)){let e=this.chunks[t];e.version=this.stamp,e.touched=!0}this.pool.setVolume(this.labels,this.shape)}setStyle(e){this.style=e}aim(e){let t=[],n=new Kr;for(let r of this.chunks){if(n.set(r.middle,Wv),!e.frustum.intersectsSphere(n)){r.show(null);continue}let i=e.eye?Math.hypot(...e.eye.map((e,t)=>e-r.low[t]-16)):0,a=Bv(e.pixels(Math.max(i-Wv,1)),e.coarse),o=this.style===`cubes`?1:a;r.isFresh(o,this.style)||t.push({chunk:r,step:o,away:i}),this.turn(r,o,e)}this.settled=t.length===0,this.settled||this.order(t.sort((e,t)=>e.away-t.away),e)}dispose(){this.clear(),this.pool.dispose()}clear(){for(let e of this.chunks)for(let t of[1,2,4])e.drop(t);this.chunks=[],this.pool.replace([])}turn(e,t,{eye:n,direction:r}){let i=e.best(t,this.style);if(e.show(i),!i?.mesh)return;let a=[0,1,2,3,4,5].map(t=>{let i=t%3;return n?t<3?n[i]>e.low[i]:n[i]<e.low[i]+32:t<3?r[i]<0:r[i]>0});i.mesh.geometry.groups=wv(a,i.starts)}order(e,t){let n=this.chunks.length<=Vv?e:e.filter(({chunk:e})=>e.touched);if(n.length<=Vv)for(let{chunk:e,step:r}of n)this.put(e,r,cv(this.labels,this.shape,e.low,r,this.style),this.style),this.turn(e,r,t);let r=e.filter(({chunk:e,step:t})=>!e.isFresh(t,this.style));this.settled=r.length===0;let i=r.length>Hv&&this.style===`greedy`;this.pool.replace(r.map(({chunk:e,step:t})=>({key:e.key,epoch:e.version,low:e.low,step:i&&!e.built.size?4:t,style:this.style})))}receive({key:e,epoch:t,step:n,style:r,mesh:i}){let a=this.chunks[e];a&&a.version===t&&r===this.style&&(this.put(a,n,i,r),this.changed())}put(e,t,n,r){e.drop(t),this.made+=1;let i=n.starts[6],a=null;i&&(this.growIndex(i),a=Sv(e.low,n,this.index,r===`cubes`?this.material.cubes:this.material.greedy),a.visible=!1,this.group.add(a),a.updateMatrixWorld(!0)),e.built.set(t,{mesh:a,starts:n.starts,version:e.version,style:r}),e.touched&&t===1&&(e.touched=!1)}growIndex(e){if(!(this.index.count>=e*6)){this.index=Cv(Math.max(e,this.index.count/3));for(let{built:e}of this.chunks)for(let{mesh:t}of e.values())t?.geometry.setIndex(this.index)}}touchedBy(e){let[,t,n]=this.shape,[r,i,a]=this.counts,o=new Set,s=(e,t,n)=>{e<0||t<0||n<0||e>=r||t>=i||n>=a||o.add((e*i+t)*a+n)};for(let r of e){let e=r%n,i=(r-e)/n,a=i%t,o=(i-a)/t,[c,l,u]=[o>>Uv,a>>Uv,e>>Uv];s(c,l,u),Kv(o)&&s(c+Kv(o),l,u),Kv(a)&&s(c,l+Kv(a),u),Kv(e)&&s(c,l,u+Kv(e))}return o}};function Kv(e){let t=e&31;return t===0?-1:+(t===31)}var qv=`http://www.w3.org/2000/svg`,Jv=21,Yv=92,Xv=[[1,0,0],[0,1,0],[0,0,1],[-1,0,0],[0,-1,0],[0,0,-1]],Zv=[[0,1,0],[-1,0,0],[1,0,0],[0,-1,0],[1,0,0],[1,0,0]],Qv=[[0,0,1],[0,0,1],[0,1,0],[0,0,1],[0,0,1],[0,-1,0]];function $v(e,{back:t,right:n,up:r}){if(pu(Xv[e],t)<.02)return null;let i=e=>[pu(e,n),-pu(e,r)],[a,o]=[i(Zv[e]),i(Qv[e].map(e=>-e))],s=i(Xv[e]).map(e=>e*Jv);return[...a,...o,...s]}var ey=class{root=document.createElementNS(qv,`svg`);sides;constructor(e,t){this.root.setAttribute(`class`,`compass`),this.root.setAttribute(`viewBox`,`-46 -46 ${Yv} ${Yv}`),this.root.setAttribute(`aria-hidden`,`true`),this.sides=Xv.map((e,n)=>this.side(n,()=>t(n))),e.after(this.root)}turn(e){this.root.classList.toggle(`is-off`,e===null),this.sides.forEach((t,n)=>{let r=e&&$v(n,e);t.classList.toggle(`is-off`,!r),e&&r&&(t.setAttribute(`transform`,`matrix(${r.map(e=>e.toFixed(4)).join(` `)})`),t.classList.toggle(`is-ahead`,pu(Xv[n],e.back)>.995))})}dispose(){this.root.remove()}side(e,t){let r=document.createElementNS(qv,`g`);r.setAttribute(`class`,`compass-side is-${`xyz`[e%3]}`);let i=document.createElementNS(qv,`rect`);for(let[e,t]of Object.entries({x:-21,y:-21,width:42,height:42,rx:3}))i.setAttribute(e,String(t));let a=document.createElementNS(qv,`text`);return a.textContent=n.compass[e],r.append(i,a),r.addEventListener(`click`,t),this.root.append(r),r}},ty=1,ny=2,ry=class{material;changed;difference=null;colour=null;loading=-1;of=``;constructor(e,t){this.material=e,this.changed=t}setDifference(e,t){this.difference=e&&new Uint8Array(t);for(let[t,n]of[[ty,e?.added],[ny,e?.changed]])for(let[e,r]of n??[])this.difference.fill(t,e,e+r);this.of=``}take(e,t,n,r){let i=t[0]*t[1]*t[2],a=`${e} ${r} ${t.join()}`;if(e===`class`)return e;e===`colour`&&this.colour?.rev!==r&&this.load(r,i);let o={confidence:n.length===i?n:null,colour:this.colour?.data??null,difference:this.difference??new Uint8Array(i)}[e];return!o||o.length<i?`class`:((this.of!==a||e===`colour`&&this.colour?.rev===r)&&(this.upload(o,t,o.length===i*4),this.of=a),e)}upload(e,t,n){let{field:r}=this.material.uniforms;r.value?.dispose();let i=new wn(e,t[2],t[1],t[0]);i.format=n?_e:be,i.unpackAlignment=1,i.needsUpdate=!0,r.value=i}async load(e,t){if(this.loading===e)return;this.loading=e;let n=await fetch(`api/volume?what=colour`).catch(()=>null);if(this.loading=-1,!n?.ok)return;let r=new Uint8Array(await n.arrayBuffer()).subarray(-3*t);if(r.length!==3*t)return;let i=new Uint8Array(4*t);for(let e=0;e<t;e++)i[4*e]=r[3*e],i[4*e+1]=r[3*e+1],i[4*e+2]=r[3*e+2];this.colour={data:i,rev:e},this.of=``,this.changed()}},iy=160,ay=3,oy=class{quality;paint;lastMs=0;asked=0;timer=0;wanted=!1;began=0;unusual=1;waiting=[];constructor(e,t){this.quality=e,this.paint=t}invalidate(){clearTimeout(this.timer),this.wanted=!0,this.ask()}idle(){return new Promise(e=>{this.waiting.push(e),this.invalidate()})}dispose(){cancelAnimationFrame(this.asked),clearTimeout(this.timer)}later(e){requestAnimationFrame(()=>{this.wanted||(this.timer=window.setTimeout(e,0))})}ask(){this.asked||=requestAnimationFrame(e=>this.tick(e))}tick(e){this.asked=0,this.began&&=(this.unusual||(this.lastMs=performance.now()-this.began,this.quality.took(this.lastMs)),0),this.wanted&&this.draw(e)}draw(e){this.wanted=!1,this.began=performance.now();let{again:t,settled:n,usual:r}=this.paint(this.quality.moving,e,null);this.unusual=r?Math.max(this.unusual-1,0):ay,this.wanted=t,this.ask(),!t&&n&&(this.timer=window.setTimeout(()=>this.drawFull(),this.waiting.length?0:iy))}drawFull(e=0){if(this.wanted)return;this.unusual=Math.max(this.unusual,1);let{again:t,settled:n,more:r}=this.paint(this.quality.still,performance.now(),e);if(t)this.invalidate();else if(n&&r)this.later(()=>this.drawFull(e+1));else if(n)for(let e of this.waiting.splice(0))e()}},sy=`
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
`,cy=`
precision highp float;
uniform sampler2D picture;
uniform float share;
in vec2 at;
out vec4 colour;
void main() {
  colour = vec4(texture(picture, at).rgb, share);
}
`,ly=class{renderer;one=new Sn(1,1);sum=new Sn(1,1,{type:le,depthBuffer:!1});copy=new Oi(new ei().setAttribute(`position`,new zr(new Float32Array(9),3)),new Fa({glslVersion:_t,vertexShader:sy,fragmentShader:cy,uniforms:{picture:{value:null},share:{value:1}},transparent:!0,depthTest:!1,depthWrite:!1}));constructor(e){this.renderer=e,this.copy.frustumCulled=!1}add(e,t,n){let{renderer:r,one:i,sum:a}=this,{x:o,y:s}=r.getDrawingBufferSize(new W);i.setSize(o,s),a.setSize(o,s);let{background:c}=t;c instanceof X&&(t.background=c.clone().convertLinearToSRGB()),r.setRenderTarget(i),r.render(t,n),t.background=c,r.autoClear=!1,this.draw(i.texture,a,1/(e+1),n),this.draw(a.texture,null,1,n),r.autoClear=!0}dispose(){this.one.dispose(),this.sum.dispose(),this.copy.geometry.dispose(),this.copy.material.dispose()}draw(e,t,n,r){let{uniforms:i}=this.copy.material;i.picture.value=e,i.share.value=n,this.copy.material.uniformsNeedUpdate=!0,this.renderer.setRenderTarget(t),this.renderer.render(this.copy,r)}},uy=`
precision highp float;
uniform mat4 projectionMatrix, modelViewMatrix;
uniform vec4 tint;
in vec3 position;
out vec4 shade;
#ifdef COLOURS
in vec4 color;
#endif
void main() {
  shade = tint;
#ifdef COLOURS
  shade *= color;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`,dy=`
precision highp float;
in vec4 shade;
out vec4 colour;
void main() {
  colour = shade;
}
`,fy=`
precision highp float;
uniform mat4 projectionMatrix, viewMatrix;
in vec3 position; // the centre
in vec4 ball; // corner x y, radius in metres, width of the rim as a share of it
in vec4 color, edge;
out vec2 at;
flat out float rim;
flat out vec4 fill, line;
void main() {
  at = ball.xy * (1.0 + ball.w);
  rim = 1.0 + ball.w;
  fill = color;
  line = edge;
  vec4 middle = viewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * (middle + vec4(at * ball.z, 0.0, 0.0));
}
`,py=`
precision highp float;
in vec2 at;
flat in float rim;
flat in vec4 fill, line;
out vec4 colour;
void main() {
  float away = length(at);
  float soft = fwidth(away);
  float light = 1.04 - 0.22 * clamp(dot(at, vec2(0.5, -0.6)) + 0.2, 0.0, 1.0);
  vec4 inside = vec4(fill.rgb * light, fill.a);
  colour = mix(inside, line, smoothstep(1.0 - soft, 1.0, away));
  colour.a *= 1.0 - smoothstep(rim - soft, rim, away);
}
`;function my(e,t,n={}){let{colours:r,...i}=n,{r:a,g:o,b:s}=gy(e);return new Fa({glslVersion:_t,vertexShader:uy,fragmentShader:dy,defines:r?{COLOURS:``}:{},uniforms:{tint:{value:new J(a,o,s,t)}},transparent:!0,depthWrite:!1,...i})}function hy(){return new Fa({glslVersion:_t,vertexShader:fy,fragmentShader:py,transparent:!0,depthTest:!1,depthWrite:!1})}function gy(e){return new X(e).getRGB({r:0,g:0,b:0},dt)}var _y=2.5,vy=class{lines=new aa(new ei,my(`#ffffff`,1,{colours:!0}));of=``;constructor(){this.lines.frustumCulled=!1,this.lines.renderOrder=-1}take(e,t,n){let r=[...e,...t,n].join();if(r===this.of)return;this.of=r;let i=Math.max(t[0]-e[0],t[1]-e[1]),a=i>40?5:i>15?1:.5,o=[0,1].map(t=>Math.floor((e[t]-_y)/a)),s=[0,1].map(e=>Math.ceil((t[e]+_y)/a)),c=[],l=[],u=+!!n,d=(n,r,i)=>{let a=Math.max(e[0]-n,n-t[0],e[1]-r,r-t[1],0),o=Math.max(1-a/_y,0)**2*(i?.22:.11);c.push(n,r,e[2]-.004),l.push(u,u,u,o)};for(let e of[0,1])for(let t=o[e];t<=s[e];t++){let n=+(e===0);for(let r=o[n];r<s[n];r++)for(let n of[r,r+1]){let r=e===0?[t,n]:[n,t];d(r[0]*a,r[1]*a,t*a%(a*2)==0)}}let{geometry:f}=this.lines;f.setAttribute(`position`,new Hr(c,3)),f.setAttribute(`color`,new Hr(l,4))}dispose(){this.lines.geometry.dispose(),this.lines.material.dispose()}};function yy(e,t){let n=Array.from({length:256},(t,n)=>$_(n)&&(e.solo===null?!e.hidden.has(n):n===e.solo)),r=[0,0,0],i=[...t],a=(e,t,n)=>{r[e]=Math.max(r[e],Math.min(t,n)),i[e]=Math.min(i[e],Math.max(t,n)+1)};if(e.slice&&a(e.slice.axis,e.slice.low,e.slice.high),e.section)for(let t=0;t<3;t++)a(t,e.section.low[t],e.section.high[t]);return{visible:n,low:r,high:i}}var by=2046;function xy({labels:e,shape:t},n){if(Math.max(...t)>by)return null;let[r,i,a]=t.map(e=>e+2),o=Uint8Array.from({length:256},(e,t)=>n[t]?255:0),s=new Uint8Array(r*i*a),c=0;for(let t=1;t<r-1;t++)for(let n=1;n<i-1;n++){let r=(t*i+n)*a+1;for(let t=0;t<a-2;t++)s[r+t]=o[e[c++]]}let l=new wn(s,a,i,r);return l.format=be,l.minFilter=l.magFilter=P,l.unpackAlignment=1,l.needsUpdate=!0,l}var Sy=.995,Cy=class{material;chunks;fields;caps;seen={visible:[],low:[0,0,0],high:[0,0,0]};shadowsOf=``;constructor(e,t,n,r){this.material=e,this.chunks=t,this.fields=n,this.caps=r}forget(){this.shadowsOf=``,this.caps.forget()}take({scene:e,view:t,confidence:n},r){if(!e||!r.length)return;this.seen=yy(t,e.shape);let i=[];for(let{id:t,colour:n}of e.classes)i[t]=n;this.material.setClasses(i,this.seen.visible),this.material.setBox(this.seen.low,this.seen.high),this.material.uniforms.shrink.value=t.voxelSize,this.chunks.setStyle(t.voxelSize<Sy?`cubes`:`greedy`);let a=this.takeShadows(r,e.shape),o=this.fields.take(t.colourBy,e.shape,n,e.rev);this.material.setParts({edges:t.edges,shadows:a,opacity:t.opacity,by:o}),this.caps.take(r,e.shape,this.seen,t.voxelSize>=Sy)}takeShadows(e,t){let{solid:n}=this.material.uniforms,r=this.seen.visible.length?Array.from(this.seen.visible,Number).join(``):``;return r!==this.shadowsOf&&(this.shadowsOf=r,n.value?.dispose(),n.value=xy({labels:e,shape:t},this.seen.visible)),n.value!==null}},wy=260,Ty=1e3,Ey=class{orbiting;flight=null;posed=null;wide=1;tall=1;perspective=new fo;parallel=new po;constructor(e){this.orbiting=e}get orbit(){return this.orbiting}set orbit(e){this.flight=null,this.orbiting=e}get pose(){return this.posed}set pose(e){this.flight=null,this.posed=e}get goal(){return this.flight?.to??this.orbiting}get flying(){return this.flight!==null}get aspect(){return this.wide/this.tall}get isParallel(){return!this.posed&&this.orbiting.ortho}get eye(){return this.posed?.position??ru(this.orbiting)}get axes(){if(!this.posed)return nu(this.orbiting);let{forward:e,up:t}=this.posed,n=new G(...e).cross(new G(...t)).normalize(),r=n.clone().cross(new G(...e)).normalize();return{back:e.map(e=>-e),right:n.toArray(),up:r.toArray()}}pixels(e){let t=Math.tan((this.posed?.field??Ql)/2);return this.tall/(2*(this.isParallel?iu(this.orbiting):t*e))}resize(e,t){this.wide=Math.max(e,1),this.tall=Math.max(t,1)}fly(e,t,n,r=wy){this.flight=n?null:{from:{...this.orbiting,ortho:e.ortho},to:e,start:t,lasts:r},n&&(this.orbiting=e)}step(e){if(!this.flight)return;let{from:t,to:n,start:r,lasts:i}=this.flight,a=Math.min(Math.max((e-r)/i,0),1);this.orbiting=lu(t,n,a),a===1&&(this.flight=null)}ray(e,t){if(!this.posed)return du(this.orbiting,e,t,this.wide,this.tall);let{back:n,right:r,up:i}=this.axes,a=Math.tan(this.posed.field/2),o=(2*e/this.wide-1)*this.aspect*a,s=(1-2*t/this.tall)*a,c=fu(fu(fu([0,0,0],n,-1),r,o),i,s);return{from:this.posed.position,direction:c}}project(e){return this.projector()(e)}projector(){let{eye:e,isParallel:t,wide:n,tall:r}=this,{back:i,right:a,up:o}=this.axes,s=this.pixels(1);return c=>{let[l,u,d]=[c[0]-e[0],c[1]-e[1],c[2]-e[2]],f=-(l*i[0]+u*i[1]+d*i[2]);if(!t&&f<=1e-6)return null;let p=t?s:s/f,m=l*a[0]+u*a[1]+d*a[2];return[n/2+m*p,r/2-(l*o[0]+u*o[1]+d*o[2])*p]}}camera(){let{back:e,right:t,up:n}=this.axes,r=this.isParallel?this.parallel:this.perspective;if(r===this.perspective)this.perspective.fov=(this.posed?.field??Ql)*180/Math.PI,this.perspective.aspect=this.aspect,this.perspective.near=this.posed?.02:Math.max(this.orbiting.distance/200,.02),this.perspective.far=(this.posed?0:this.orbiting.distance)+Ty;else{let e=iu(this.orbiting);Object.assign(this.parallel,{top:e,bottom:-e,near:-1e3,far:Ty}),Object.assign(this.parallel,{left:-e*this.aspect,right:e*this.aspect})}let i=[t,n,e].map(e=>new G(...e));return r.matrixAutoUpdate=!1,r.matrix.makeBasis(i[0],i[1],i[2]).setPosition(...this.eye),r.matrix.decompose(r.position,r.quaternion,r.scale),r.updateProjectionMatrix(),r.updateMatrixWorld(!0),r}},Dy={target:[0,0,0],azimuth:-125*Math.PI/180,elevation:50*Math.PI/180,distance:8,ortho:!1},Oy=class{sight=new Ey(Dy);get orbit(){return this.sight.orbit}set orbit(e){this.sight.orbit=e,this.invalidate()}get pose(){return this.sight.pose}set pose(e){this.sight.pose=e,this.invalidate()}project(e){return this.measure().project(e)}frame(){let e=this.box();e&&this.flyTo(cu({...this.sight.goal},e.low,e.high,this.measure().aspect))}focus(e){let t=e.low.map((t,n)=>Math.max((e.high[n]-t)*.35,.15)),n=e.low.map((e,n)=>e-t[n]),r=e.high.map((e,n)=>e+t[n]);this.flyTo(cu(this.sight.goal,n,r,this.measure().aspect))}turn(e,t){this.flyTo(au(this.sight.goal,e,t))}pan(e,t){this.flyTo(ou(this.sight.goal,e,t))}zoom(e){this.flyTo(su(this.sight.goal,e,null))}lookAlong(e,t=!1){let n=Math.PI/2,r=e===2?-n:e===0?t?0:Math.PI:t?n:-n,i=e===2?(t?-1:1)*(n-1e-4):0;this.flyTo({...this.sight.goal,azimuth:r,elevation:i})}lookFrom(e){let t=e%3,n=t===2?e>2:e<3,r=Math.abs(this.sight.axes.back[t])>.999;this.lookAlong(t,r?!n:n)}flyTo(e){let t=matchMedia(`(prefers-reduced-motion: reduce)`).matches;this.sight.fly(e,performance.now(),t),this.invalidate()}box(){let{scene:e}=this.store.get();if(!e)return null;let t=e.origin_m.map((t,n)=>t+e.shape[n]*e.voxel_m);return{low:e.origin_m,high:t}}measure(){return this.sight.resize(this.canvas.clientWidth,this.canvas.clientHeight),this.sight}};Q.line={worldUnits:{value:1},linewidth:{value:1},resolution:{value:new W},dashOffset:{value:0},dashScale:{value:1},dashSize:{value:1},gapSize:{value:1}},Wo.line={uniforms:ja.merge([Q.common,Q.fog,Q.line]),vertexShader:`
		#include <common>
		#include <color_pars_vertex>
		#include <fog_pars_vertex>
		#include <logdepthbuf_pars_vertex>
		#include <clipping_planes_pars_vertex>

		uniform float linewidth;
		uniform vec2 resolution;

		attribute vec3 instanceStart;
		attribute vec3 instanceEnd;

		attribute vec3 instanceColorStart;
		attribute vec3 instanceColorEnd;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#ifdef USE_DASH

			uniform float dashScale;
			attribute float instanceDistanceStart;
			attribute float instanceDistanceEnd;
			varying float vLineDistance;

		#endif

		float trimSegmentAlpha( const in vec4 start, const in vec4 end ) {

			// compute the interpolation factor needed to trim the segment so it terminates
			// between the camera plane and the near plane

			// conservative estimate of the near plane
			float a = projectionMatrix[ 2 ][ 2 ]; // 3nd entry in 3th column
			float b = projectionMatrix[ 3 ][ 2 ]; // 3nd entry in 4th column

			// we need different nearEstimate formula for reversed and default depth buffer
			// a is positive with a reversed depth buffer so it can be used for controlling the code flow
			float nearEstimate = ( a > 0.0 ) ? ( - b / ( a + 1.0 ) ) : ( - 0.5 * b / a );

			return ( nearEstimate - start.z ) / ( end.z - start.z );

		}

		void main() {

			#ifdef USE_COLOR

				vColor.xyz = ( position.y < 0.5 ) ? instanceColorStart : instanceColorEnd;

			#endif

			float aspect = resolution.x / resolution.y;

			// camera space
			vec4 start = modelViewMatrix * vec4( instanceStart, 1.0 );
			vec4 end = modelViewMatrix * vec4( instanceEnd, 1.0 );

			#ifdef USE_DASH

				float lineDistanceStart = dashScale * instanceDistanceStart;
				float lineDistanceEnd = dashScale * instanceDistanceEnd;

			#endif

			#ifdef WORLD_UNITS

				worldStart = start.xyz;
				worldEnd = end.xyz;

			#else

				vUv = uv;

			#endif

			// special case for perspective projection, and segments that terminate either in, or behind, the camera plane
			// clearly the gpu firmware has a way of addressing this issue when projecting into ndc space
			// but we need to perform ndc-space calculations in the shader, so we must address this issue directly
			// perhaps there is a more elegant solution -- WestLangley

			bool perspective = ( projectionMatrix[ 2 ][ 3 ] == - 1.0 ); // 4th entry in the 3rd column

			if ( perspective ) {

				if ( start.z < 0.0 && end.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( start, end );
					end.xyz = mix( start.xyz, end.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceEnd = mix( lineDistanceStart, lineDistanceEnd, alpha );

					#endif

				} else if ( end.z < 0.0 && start.z >= 0.0 ) {

					float alpha = trimSegmentAlpha( end, start );
					start.xyz = mix( end.xyz, start.xyz, alpha );

					#ifdef USE_DASH

						lineDistanceStart = mix( lineDistanceEnd, lineDistanceStart, alpha );

					#endif

				}

			}

			#ifdef USE_DASH

				vLineDistance = ( position.y < 0.5 ) ? lineDistanceStart : lineDistanceEnd;
				vUv = uv;

			#endif

			// clip space
			vec4 clipStart = projectionMatrix * start;
			vec4 clipEnd = projectionMatrix * end;

			// ndc space
			vec3 ndcStart = clipStart.xyz / clipStart.w;
			vec3 ndcEnd = clipEnd.xyz / clipEnd.w;

			// direction
			vec2 dir = ndcEnd.xy - ndcStart.xy;

			// account for clip-space aspect ratio
			dir.x *= aspect;
			dir = normalize( dir );

			#ifdef WORLD_UNITS

				vec3 worldDir = normalize( end.xyz - start.xyz );
				vec3 tmpFwd = perspective ? normalize( mix( start.xyz, end.xyz, 0.5 ) ) : vec3( 0.0, 0.0, - 1.0 );
				vec3 worldUp = normalize( cross( worldDir, tmpFwd ) );
				vec3 worldFwd = cross( worldDir, worldUp );
				worldPos = position.y < 0.5 ? start: end;

				// height offset
				float hw = linewidth * 0.5;
				worldPos.xyz += position.x < 0.0 ? hw * worldUp : - hw * worldUp;

				// don't extend the line if we're rendering dashes because we
				// won't be rendering the endcaps
				#ifndef USE_DASH

					// cap extension
					worldPos.xyz += position.y < 0.5 ? - hw * worldDir : hw * worldDir;

					// add width to the box
					worldPos.xyz += worldFwd * hw;

					// endcaps
					if ( position.y > 1.0 || position.y < 0.0 ) {

						worldPos.xyz -= worldFwd * 2.0 * hw;

					}

				#endif

				// project the worldpos
				vec4 clip = projectionMatrix * worldPos;

				// shift the depth of the projected points so the line
				// segments overlap neatly
				vec3 clipPose = ( position.y < 0.5 ) ? ndcStart : ndcEnd;

				// only shift the depth of vertices in front of the camera (#35137)
				if ( clip.w > 0.0 ) clip.z = clipPose.z * clip.w;

			#else

				vec2 offset = vec2( dir.y, - dir.x );
				// undo aspect ratio adjustment
				dir.x /= aspect;
				offset.x /= aspect;

				// sign flip
				if ( position.x < 0.0 ) offset *= - 1.0;

				// endcaps
				if ( position.y < 0.0 ) {

					offset += - dir;

				} else if ( position.y > 1.0 ) {

					offset += dir;

				}

				// adjust for linewidth
				offset *= linewidth;

				// adjust for clip-space to screen-space conversion // maybe resolution should be based on viewport ...
				offset /= resolution.y;

				// select end
				vec4 clip = ( position.y < 0.5 ) ? clipStart : clipEnd;

				// back to clip space
				offset *= clip.w;

				clip.xy += offset;

			#endif

			gl_Position = clip;

			vec4 mvPosition = ( position.y < 0.5 ) ? start : end; // this is an approximation

			#include <logdepthbuf_vertex>
			#include <clipping_planes_vertex>
			#include <fog_vertex>

		}
		`,fragmentShader:`
		uniform vec3 diffuse;
		uniform float opacity;
		uniform float linewidth;

		#ifdef USE_DASH

			uniform float dashOffset;
			uniform float dashSize;
			uniform float gapSize;

		#endif

		varying float vLineDistance;

		#ifdef WORLD_UNITS

			varying vec4 worldPos;
			varying vec3 worldStart;
			varying vec3 worldEnd;

			#ifdef USE_DASH

				varying vec2 vUv;

			#endif

		#else

			varying vec2 vUv;

		#endif

		#include <common>
		#include <color_pars_fragment>
		#include <fog_pars_fragment>
		#include <logdepthbuf_pars_fragment>
		#include <clipping_planes_pars_fragment>

		vec2 closestLineToLine(vec3 p1, vec3 p2, vec3 p3, vec3 p4) {

			float mua;
			float mub;

			vec3 p13 = p1 - p3;
			vec3 p43 = p4 - p3;

			vec3 p21 = p2 - p1;

			float d1343 = dot( p13, p43 );
			float d4321 = dot( p43, p21 );
			float d1321 = dot( p13, p21 );
			float d4343 = dot( p43, p43 );
			float d2121 = dot( p21, p21 );

			float denom = d2121 * d4343 - d4321 * d4321;

			float numer = d1343 * d4321 - d1321 * d4343;

			mua = numer / denom;
			mua = clamp( mua, 0.0, 1.0 );
			mub = ( d1343 + d4321 * ( mua ) ) / d4343;
			mub = clamp( mub, 0.0, 1.0 );

			return vec2( mua, mub );

		}

		void main() {

			float alpha = opacity;
			vec4 diffuseColor = vec4( diffuse, alpha );

			#include <clipping_planes_fragment>

			#ifdef USE_DASH

				if ( vUv.y < - 1.0 || vUv.y > 1.0 ) discard; // discard endcaps

				if ( mod( vLineDistance + dashOffset, dashSize + gapSize ) > dashSize ) discard; // todo - FIX

			#endif

			#ifdef WORLD_UNITS

				float len;

				if ( isOrthographic ) {

					// View rays are parallel to the z axis so the distance reduces to camera-space XY
					vec2 lineDir = worldEnd.xy - worldStart.xy;
					float t = clamp( dot( worldPos.xy - worldStart.xy, lineDir ) / dot( lineDir, lineDir ), 0.0, 1.0 );
					len = length( worldStart.xy + lineDir * t - worldPos.xy );

				} else {

					// Find the closest points on the view ray and the line segment
					vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;
					vec3 lineDir = worldEnd - worldStart;
					vec2 params = closestLineToLine( worldStart, worldEnd, vec3( 0.0, 0.0, 0.0 ), rayEnd );

					vec3 p1 = worldStart + lineDir * params.x;
					vec3 p2 = rayEnd * params.y;
					vec3 delta = p1 - p2;
					len = length( delta );

				}

				float norm = len / linewidth;

				#ifndef USE_DASH

					#ifdef USE_ALPHA_TO_COVERAGE

						float dnorm = fwidth( norm );
						alpha = 1.0 - smoothstep( 0.5 - dnorm, 0.5 + dnorm, norm );

					#else

						if ( norm > 0.5 ) {

							discard;

						}

					#endif

				#endif

			#else

				#ifdef USE_ALPHA_TO_COVERAGE

					// artifacts appear on some hardware if a derivative is taken within a conditional
					float a = vUv.x;
					float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
					float len2 = a * a + b * b;
					float dlen = fwidth( len2 );

					if ( abs( vUv.y ) > 1.0 ) {

						alpha = 1.0 - smoothstep( 1.0 - dlen, 1.0 + dlen, len2 );

					}

				#else

					if ( abs( vUv.y ) > 1.0 ) {

						float a = vUv.x;
						float b = ( vUv.y > 0.0 ) ? vUv.y - 1.0 : vUv.y + 1.0;
						float len2 = a * a + b * b;

						if ( len2 > 1.0 ) discard;

					}

				#endif

			#endif

			#include <logdepthbuf_fragment>
			#include <color_fragment>

			gl_FragColor = vec4( diffuseColor.rgb, alpha );

			#include <tonemapping_fragment>
			#include <colorspace_fragment>
			#include <fog_fragment>
			#include <premultiplied_alpha_fragment>

		}
		`};var ky=class extends Pa{constructor(e){super({type:`LineMaterial`,uniforms:ja.clone(Wo.line.uniforms),vertexShader:Wo.line.vertexShader,fragmentShader:Wo.line.fragmentShader,clipping:!0}),this.isLineMaterial=!0,this.setValues(e)}get color(){return this.uniforms.diffuse.value}set color(e){this.uniforms.diffuse.value=e}get worldUnits(){return`WORLD_UNITS`in this.defines}set worldUnits(e){e===!0!==this.worldUnits&&(this.needsUpdate=!0),e===!0?this.defines.WORLD_UNITS=``:delete this.defines.WORLD_UNITS}get linewidth(){return this.uniforms.linewidth.value}set linewidth(e){this.uniforms.linewidth&&(this.uniforms.linewidth.value=e)}get dashed(){return`USE_DASH`in this.defines}set dashed(e){e===!0!==this.dashed&&(this.needsUpdate=!0),e===!0?this.defines.USE_DASH=``:delete this.defines.USE_DASH}get dashScale(){return this.uniforms.dashScale.value}set dashScale(e){this.uniforms.dashScale.value=e}get dashSize(){return this.uniforms.dashSize.value}set dashSize(e){this.uniforms.dashSize.value=e}get dashOffset(){return this.uniforms.dashOffset.value}set dashOffset(e){this.uniforms.dashOffset.value=e}get gapSize(){return this.uniforms.gapSize.value}set gapSize(e){this.uniforms.gapSize.value=e}get opacity(){return this.uniforms.opacity.value}set opacity(e){this.uniforms&&(this.uniforms.opacity.value=e)}get resolution(){return this.uniforms.resolution.value}set resolution(e){this.uniforms.resolution.value.copy(e)}get alphaToCoverage(){return`USE_ALPHA_TO_COVERAGE`in this.defines}set alphaToCoverage(e){this.defines&&(e===!0!==this.alphaToCoverage&&(this.needsUpdate=!0),e===!0?this.defines.USE_ALPHA_TO_COVERAGE=``:delete this.defines.USE_ALPHA_TO_COVERAGE)}},Ay=new xr,jy=new G,My=class extends mo{constructor(){super(),this.isLineSegmentsGeometry=!0,this.type=`LineSegmentsGeometry`,this.setIndex([0,2,1,2,3,1,2,4,3,4,5,3,4,6,5,6,7,5]),this.setAttribute(`position`,new Hr([-1,2,0,1,2,0,-1,1,0,1,1,0,-1,0,0,1,0,0,-1,-1,0,1,-1,0],3)),this.setAttribute(`uv`,new Hr([-1,2,1,2,-1,1,1,1,-1,-1,1,-1,-1,-2,1,-2],2))}applyMatrix4(e){let t=this.attributes.instanceStart,n=this.attributes.instanceEnd;return t!==void 0&&(t.applyMatrix4(e),n.applyMatrix4(e),t.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this}setPositions(e){let t;e instanceof Float32Array?t=e:Array.isArray(e)&&(t=new Float32Array(e));let n=new jo(t,6,1);return this.setAttribute(`instanceStart`,new ii(n,3,0)),this.setAttribute(`instanceEnd`,new ii(n,3,3)),this.instanceCount=this.attributes.instanceStart.count,this.computeBoundingBox(),this.computeBoundingSphere(),this}setColors(e){let t;e instanceof Float32Array?t=e:Array.isArray(e)&&(t=new Float32Array(e));let n=new jo(t,6,1);return this.setAttribute(`instanceColorStart`,new ii(n,3,0)),this.setAttribute(`instanceColorEnd`,new ii(n,3,3)),this}fromWireframeGeometry(e){return this.setPositions(e.attributes.position.array),this}fromEdgesGeometry(e){return this.setPositions(e.attributes.position.array),this}fromMesh(e){return this.fromWireframeGeometry(new wa(e.geometry)),this}fromLineSegments(e){let t=e.geometry;return this.setPositions(t.attributes.position.array),this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new xr);let e=this.attributes.instanceStart,t=this.attributes.instanceEnd;e!==void 0&&t!==void 0&&(this.boundingBox.setFromBufferAttribute(e),Ay.setFromBufferAttribute(t),this.boundingBox.union(Ay))}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Kr),this.boundingBox===null&&this.computeBoundingBox();let e=this.attributes.instanceStart,t=this.attributes.instanceEnd;if(e!==void 0&&t!==void 0){let n=this.boundingSphere.center;this.boundingBox.getCenter(n);let r=0;for(let i=0,a=e.count;i<a;i++)jy.fromBufferAttribute(e,i),r=Math.max(r,n.distanceToSquared(jy)),jy.fromBufferAttribute(t,i),r=Math.max(r,n.distanceToSquared(jy));this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&console.error(`THREE.LineSegmentsGeometry.computeBoundingSphere(): Computed radius is NaN. The instanced position data is likely to have NaN values.`,this)}}toJSON(){}},Ny=new J,Py=new G,Fy=new G,Iy=new J,Ly=new J,Ry=new J,zy=new G,By=new Y,Vy=new zo,Hy=new G,Uy=new xr,Wy=new Kr,Gy=new J,Ky,qy;function Jy(e,t,n){return Gy.set(0,0,-t,1).applyMatrix4(e.projectionMatrix),Gy.multiplyScalar(1/Gy.w),Gy.x=qy/n.width,Gy.y=qy/n.height,Gy.applyMatrix4(e.projectionMatrixInverse),Gy.multiplyScalar(1/Gy.w),Math.abs(Math.max(Gy.x,Gy.y))}function Yy(e,t){let n=e.matrixWorld,r=e.geometry,i=r.attributes.instanceStart,a=r.attributes.instanceEnd,o=Math.min(r.instanceCount,i.count);for(let r=0,s=o;r<s;r++){Vy.start.fromBufferAttribute(i,r),Vy.end.fromBufferAttribute(a,r),Vy.applyMatrix4(n);let o=new G,s=new G;Ky.distanceSqToSegment(Vy.start,Vy.end,s,o),s.distanceTo(o)<qy*.5&&t.push({point:s,pointOnLine:o,distance:Ky.origin.distanceTo(s),object:e,face:null,faceIndex:r,uv:null,uv1:null})}}function Xy(e,t,n){let r=t.projectionMatrix,i=e.material.resolution,a=e.matrixWorld,o=e.geometry,s=o.attributes.instanceStart,c=o.attributes.instanceEnd,l=Math.min(o.instanceCount,s.count),u=-t.near;Ky.at(1,Ry),Ry.w=1,Ry.applyMatrix4(t.matrixWorldInverse),Ry.applyMatrix4(r),Ry.multiplyScalar(1/Ry.w),Ry.x*=i.x/2,Ry.y*=i.y/2,Ry.z=0,zy.copy(Ry),By.multiplyMatrices(t.matrixWorldInverse,a);for(let t=0,o=l;t<o;t++){if(Iy.fromBufferAttribute(s,t),Ly.fromBufferAttribute(c,t),Iy.w=1,Ly.w=1,Iy.applyMatrix4(By),Ly.applyMatrix4(By),Iy.z>u&&Ly.z>u)continue;if(Iy.z>u){let e=Iy.z-Ly.z,t=(Iy.z-u)/e;Iy.lerp(Ly,t)}else if(Ly.z>u){let e=Ly.z-Iy.z,t=(Ly.z-u)/e;Ly.lerp(Iy,t)}Iy.applyMatrix4(r),Ly.applyMatrix4(r),Iy.multiplyScalar(1/Iy.w),Ly.multiplyScalar(1/Ly.w),Iy.x*=i.x/2,Iy.y*=i.y/2,Ly.x*=i.x/2,Ly.y*=i.y/2,Vy.start.copy(Iy),Vy.start.z=0,Vy.end.copy(Ly),Vy.end.z=0;let o=Vy.closestPointToPointParameter(zy,!0);Vy.at(o,Hy);let l=nn.lerp(Iy.z,Ly.z,o),d=l>=-1&&l<=1,f=zy.distanceTo(Hy)<qy*.5;if(d&&f){Vy.start.fromBufferAttribute(s,t),Vy.end.fromBufferAttribute(c,t),Vy.start.applyMatrix4(a),Vy.end.applyMatrix4(a);let r=new G,i=new G;Ky.distanceSqToSegment(Vy.start,Vy.end,i,r),n.push({point:i,pointOnLine:r,distance:Ky.origin.distanceTo(i),object:e,face:null,faceIndex:t,uv:null,uv1:null})}}}var Zy=class extends Oi{constructor(e=new My,t=new ky({color:Math.random()*16777215})){super(e,t),this.isLineSegments2=!0,this.type=`LineSegments2`}computeLineDistances(){let e=this.geometry,t=e.attributes.instanceStart,n=e.attributes.instanceEnd,r=new Float32Array(2*t.count);for(let e=0,i=0,a=t.count;e<a;e++,i+=2)Py.fromBufferAttribute(t,e),Fy.fromBufferAttribute(n,e),r[i]=i===0?0:r[i-1],r[i+1]=r[i]+Py.distanceTo(Fy);let i=new jo(r,2,1);return e.setAttribute(`instanceDistanceStart`,new ii(i,1,0)),e.setAttribute(`instanceDistanceEnd`,new ii(i,1,1)),this}raycast(e,t){let n=this.material.worldUnits,r=e.camera;if(r===null&&!n&&console.error(`LineSegments2: "Raycaster.camera" needs to be set in order to raycast against LineSegments2 while worldUnits is set to false.`),n===!1&&(this.material.resolution.x===0||this.material.resolution.y===0))return;let i=e.params.Line2===void 0?0:e.params.Line2.threshold||0;Ky=e.ray;let a=this.matrixWorld,o=this.geometry,s=this.material;qy=s.linewidth+i,o.boundingSphere===null&&o.computeBoundingSphere(),Wy.copy(o.boundingSphere).applyMatrix4(a);let c;if(c=n?qy*.5:Jy(r,Math.max(r.near,Wy.distanceToPoint(Ky.origin)),s.resolution),Wy.radius+=c,Ky.intersectsSphere(Wy)===!1)return;o.boundingBox===null&&o.computeBoundingBox(),Uy.copy(o.boundingBox).applyMatrix4(a);let l;l=n?qy*.5:Jy(r,Math.max(r.near,Uy.distanceToPoint(Ky.origin)),s.resolution),Uy.expandByScalar(l),Ky.intersectsBox(Uy)!==!1&&(n?Yy(this,t):Xy(this,r,t))}onBeforeRender(e){let t=this.material.uniforms;t&&t.resolution&&(e.getViewport(Ny),this.material.uniforms.resolution.value.set(Ny.z,Ny.w))}},Qy=[[-1,-1],[1,-1],[1,1],[-1,1]],$y=.55;function eb(e,t,n){let r=(n,r)=>[e[0]+n*Math.cos(t)-r*Math.sin(t),e[1]+n*Math.sin(t)+r*Math.cos(t),e[2]];return[r(n*3.1,0),r(n*1.35,n*.95),r(n*1.35,-n*.95)]}var tb=class{group=new Qn;balls=[];covered=``;round=new Oi(new ei,hy());arrows=new Oi(new ei,my(`#ffffff`,1,{colours:!0,side:2,depthTest:!1}));constructor(){[this.arrows,this.round].forEach((e,t)=>{e.frustumCulled=!1,e.renderOrder=2+t,this.group.add(e)})}set(e){this.balls=e,this.covered=`-`,this.group.visible=e.length>0}dim(e){if(!this.balls.length)return;let t=this.balls.map(({center:t,chosen:n})=>!n&&e(t)),n=t.map(Number).join(``);n!==this.covered&&(this.covered=n,this.build(t))}dispose(){for(let e of[this.round,this.arrows])e.geometry.dispose(),e.material.dispose()}build(e){let t={position:[],ball:[],color:[],edge:[]},n={position:[],color:[]},r=[];this.balls.forEach(({center:i,yaw:a,radius:o,colour:s,edge:c,chosen:l},u)=>{for(let n of Qy)t.position.push(...i),t.ball.push(...n,o*(e[u]?$y:1),l?.42:.2),t.color.push(...s,1),t.edge.push(...c,1);if(r.push(...[0,1,2,0,2,3].map(e=>4*u+e)),!e[u])for(let e of eb(i,a,o))n.position.push(...e),n.color.push(...l?c:s,1)}),nb(this.round,t),this.round.geometry.setIndex(r),nb(this.arrows,n)}};function nb(e,t){e.geometry.dispose(),e.geometry=new ei;for(let[n,r]of Object.entries(t))e.geometry.setAttribute(n,new Hr(r,n===`position`?3:4))}var rb=[.08,.09,.11],ib={dark:[1,1,1],light:rb},ab={depthTest:!1,depthWrite:!1,transparent:!0};function ob({objects:e,view:t,mode:n,scene:r}){if(!r||n!==`inspect`&&n!==`objects`)return[];let{visible:i,low:a,high:o}=yy(t,r.shape);return[...e.values()].filter(({class_id:e,center_m:t})=>{let n=t.map((e,t)=>(e-r.origin_m[t])/r.voxel_m);return i[e]&&n.every((e,t)=>e>=a[t]&&e<=o[t])})}function sb(e,t,n){let[r,i]=[Math.cos(n),Math.sin(n)],a=n=>{let[a,o,s]=t.map((e,t)=>((n>>t&1)-.5)*e);return[e[0]+a*r-o*i,e[1]+a*i+o*r,e[2]+s]},o=[];for(let e=0;e<8;e++)for(let t of[1,2,4])e&t||o.push(...a(e),...a(e|t));return o}var cb=class{group=new Qn;outlines=new Qn;balls=new tb;lines=[];constructor(){this.group.add(this.outlines,this.balls.group)}take(e){this.clear();let{scene:t,selectedObjects:n,theme:r,view:i}=e;if(!t)return;let a=ob(e),o=e=>(t.classes[e]?.colour??[255,255,255]).map(e=>e/255);if(e.mode===`objects`)for(let e of a)this.boxes(e.placements,o(e.class_id),n.has(e.id));let s=a.filter(({id:e})=>n.has(e)).flatMap(e=>sb(e.center_m,e.size_m,lb(e.yaw_deg)));this.outline(s,ib[r],2,.95),this.balls.set(a.map(e=>{let t=n.has(e.id)?ib[r]:rb;return{center:e.center_m,yaw:lb(e.yaw_deg),radius:i.centerSize/2,colour:o(e.class_id),edge:t,chosen:n.has(e.id)}}))}resize(e,t){for(let n of this.lines)n.resolution.set(e,t)}dispose(){this.clear(),this.balls.dispose()}dim(e){this.balls.dim(e)}boxes(e,t,n){let r=e.flatMap(({center_m:e,size_m:t,quarter_turns:n})=>sb(e,t,n*Math.PI/2));this.outline(r,t,n?2:1.25,n?.9:.55)}outline(e,t,n,r){if(!e.length)return;let i=new ky({linewidth:n,opacity:r,...ab});i.color.setRGB(...t,dt),this.lines.push(i);let a=new Zy(new My().setPositions(e),i);a.renderOrder=1,a.frustumCulled=!1,this.outlines.add(a)}clear(){for(let e of[...this.outlines.children])e.removeFromParent(),e.geometry.dispose(),e.material.dispose();this.lines.length=0}};function lb(e){return e*Math.PI/180}var ub=`
precision highp float;
precision highp int;
uniform mat4 projectionMatrix, viewMatrix, modelMatrix;
uniform vec4 palette[16]; // rgb, and whether the class is drawn
uniform vec3 origin; // metres
uniform float voxel; // metres
uniform vec3 boxLow, boxHigh; // cells; what the slices leave
uniform float shrink; // side of a drawn cube, share of a cell
uniform vec2 overlap; // of neighbouring quads, in cells: a unit of depth, and everywhere
in vec4 place, kind;
out vec3 cell;
out vec2 across; // along the face, in cells
flat out vec3 normal, tint;
flat out float span, light;

const float LIGHT[6] = float[6](0.85, 0.93, 1.0, 0.79, 0.72, 0.52); // +x +y +z -x -y -z

void main() {
  int bits = int(place.w + 0.5);
  int face = bits & 7;
  int corner = bits >> 3;
  int axis = face % 3;
  vec3 n = vec3(axis == 0, axis == 1, axis == 2) * (face < 3 ? 1.0 : -1.0);
  vec3 at = (modelMatrix * vec4(place.xyz, 1.0)).xyz;
  at = floor((at - origin) / voxel + 0.5);
  int label = int(kind.x + 0.5);
  bool hidden = palette[label].a < 0.5;
#ifdef CUBES
  vec3 owner = at;
  vec3 side = vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
  at += 0.5 + (side - 0.5) * shrink;
  hidden = hidden || any(lessThan(owner, boxLow)) || any(greaterThanEqual(owner, boxHigh));
#else
  // Quads whose sides meet other corners leave pinholes between them, unless they overlap a little.
  vec3 side = vec3(corner & 1, (corner >> 1) & 1, corner >> 2) * 2.0 - 1.0;
  float deep = -(viewMatrix * vec4(origin + at * voxel, 1.0)).z;
  at += side * (1.0 - abs(n)) * (overlap.x * max(deep, 0.0) + overlap.y);
  float plane = dot(at, abs(n)), low = dot(boxLow, abs(n)), high = dot(boxHigh, abs(n));
  hidden = hidden || (face < 3 ? plane <= low || plane > high : plane < low || plane >= high);
  at = clamp(at, boxLow, boxHigh);
#endif
  if (hidden) at = boxLow; // all corners in one place: no area
  cell = at;
  across = axis == 0 ? at.yz : axis == 1 ? at.zx : at.xy;
  normal = n;
  span = kind.y;
  tint = palette[label & 15].rgb;
  light = LIGHT[face];
  gl_Position = projectionMatrix * viewMatrix * vec4(origin + at * voxel, 1.0);
}
`,db=`
precision highp float;
precision highp sampler3D;
uniform sampler3D solid; // 1 where a drawn cell is; z y x
uniform sampler3D field; // a value for each cell; z y x
uniform vec3 shape; // cells of \`solid\`: two more than the scene
uniform float edges, opacity;
uniform float grain; // number of the frame of those that are averaged
in vec3 cell;
in vec2 across;
flat in vec3 normal, tint;
flat in float span, light;
out vec4 colour;

vec3 ramp(float t) {
  const vec3 STOPS[5] = vec3[5](vec3(0.99, 0.87, 0.44), vec3(0.97, 0.62, 0.38), vec3(0.84, 0.43, 0.48),
    vec3(0.57, 0.41, 0.62), vec3(0.34, 0.45, 0.69));
  float at = clamp(t, 0.0, 1.0) * 3.999;
  int stop = int(at);
  return mix(STOPS[stop], STOPS[stop + 1], fract(at));
}

vec3 base() {
  ivec3 owner = ivec3(floor(cell - normal * 0.5)).zyx;
#if defined(BY_CONFIDENCE)
  return ramp(texelFetch(field, owner, 0).r);
#elif defined(BY_COLOUR)
  vec3 seen = texelFetch(field, owner, 0).rgb; // black: no photo saw it
  return seen == vec3(0.0) ? mix(vec3(dot(tint, vec3(0.3, 0.6, 0.1))), tint, 0.35) : seen;
#elif defined(BY_DIFFERENCE)
  float code = texelFetch(field, owner, 0).r * 255.0;
  vec3 same = mix(vec3(dot(tint, vec3(0.3, 0.6, 0.1))), vec3(0.62), 0.7);
  return code > 1.5 ? vec3(0.98, 0.70, 0.22) : code > 0.5 ? vec3(0.25, 0.74, 0.46) : same;
#else
  return tint;
#endif
}

void main() {
#ifdef SCREEN_DOOR
  // Layers behind each other get other patterns, else the nearest would hide all of them; each
  // goes through the eighths in an order of its own.
  float layer = fract(dot(floor(cell - normal * 0.5), vec3(0.754877, 0.569840, 0.431597)));
  float turn = grain * (1.0 + 2.0 * floor(layer * 4.0)) / 8.0;
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))) + layer + turn);
  if (noise >= opacity) discard;
#endif
  vec3 rgb = base() * light;
#ifdef SHADOWS
  float near = texture(solid, ((cell + 1.0 + normal * 0.5 * span) / shape).zyx).r;
  rgb *= 1.0 - 0.42 * near;
#endif
#ifdef EDGES
  vec2 wide = fwidth(across);
  vec2 away = abs(fract(across - 0.5) - 0.5) / wide; // pixels from the nearest line
  float line = max(wide.x, wide.y); // cells a pixel
  float edge = clamp(1.2 - min(away.x, away.y), 0.0, 1.0);
  rgb *= 1.0 - edges * edge * clamp(1.4 - 4.0 * line, 0.0, 1.0);
#endif
  colour = vec4(rgb, 1.0);
}
`,fb=class{uniforms={palette:{value:Array.from({length:16},()=>new J(1,1,1,0))},origin:{value:new G},voxel:{value:1},boxLow:{value:new G},boxHigh:{value:new G(1,1,1)},shrink:{value:1},overlap:{value:new W},solid:{value:null},field:{value:null},shape:{value:new G(1,1,1)},edges:{value:.2},opacity:{value:1},grain:{value:0}};greedy=this.variant({});cubes=this.variant({CUBES:``});variant(e){return new Fa({glslVersion:_t,vertexShader:ub,fragmentShader:db,uniforms:this.uniforms,defines:e})}setPlace(e,t,n){this.uniforms.voxel.value=e,this.uniforms.origin.value.set(...t),this.uniforms.shape.value.set(n[0]+2,n[1]+2,n[2]+2)}setBox(e,t){this.uniforms.boxLow.value.set(...e),this.uniforms.boxHigh.value.set(...t)}setOverlap(e,t){this.uniforms.overlap.value.set(t?0:e,t?e:0)}setClasses(e,t){this.uniforms.palette.value.forEach((n,r)=>{let[i,a,o]=e[r]??[255,255,255];n.set(i/255,a/255,o/255,+!!t[r])})}setParts(e){this.uniforms.opacity.value=e.opacity;let t={EDGES:e.edges,SHADOWS:e.shadows,SCREEN_DOOR:e.opacity<1,BY_CONFIDENCE:e.by===`confidence`,BY_COLOUR:e.by===`colour`,BY_DIFFERENCE:e.by===`difference`};for(let e of[this.greedy,this.cubes]){let n=e.defines;for(let[r,i]of Object.entries(t))i!==r in n&&(i?n[r]=``:delete n[r],e.needsUpdate=!0)}}dispose(){this.greedy.dispose(),this.cubes.dispose(),this.uniforms.solid.value?.dispose(),this.uniforms.field.value?.dispose()}},pb=4e5,mb=.28,hb=[.9,.96,1,.86,.8,.66],gb=[[1,0,0],[0,1,0],[0,0,1],[-1,0,0],[0,-1,0],[0,0,-1]];function _b(e,t){let n=new Set;for(let[t,r]of e)for(let e=t;e<t+r&&n.size<pb;e++)n.add(e);let r=[t[1]*t[2],t[2],1],i=[],a=[];for(let e of n){let o=Q_(t,e);gb.forEach((s,c)=>{let l=c%3,u=o[l]+s[l];if(u>=0&&u<t[l]&&n.has(e+r[l]*s[l]))return;vb(i,o,c);let d=hb[c];for(let e=0;e<4;e++)a.push(d,d,d,1)})}return{corners:Float32Array.from(i),lights:Float32Array.from(a)}}function vb(e,t,n){let r=n%3,[i,a]=[(r+1)%3,(r+2)%3],o=[[0,0],[1,0],[1,1],[0,1]];for(let[s,c]of n<3?o:[...o].reverse()){let o=[...t];o[r]+=n<3?1.02:-.02,o[i]+=s,o[a]+=c,e.push(...o)}}var yb=class{group=new Qn;shown=new Map;constructor(){this.group.matrixAutoUpdate=!1}setPlace(e,t){this.group.matrix.makeScale(e,e,e).setPosition(...t),this.group.updateMatrixWorld(!0)}set(e,t,n,r,i=.5){for(let t of this.shown.get(e)??[])this.group.remove(t),t.geometry.dispose(),t.material.dispose();if(this.shown.delete(e),!t?.length)return;let{corners:a,lights:o}=_b(t,n),s=new ei;s.setAttribute(`position`,new zr(a,3)),s.setAttribute(`color`,new zr(o,4)),s.setIndex(Cv(a.length/12));let c=[my(r,i,{colours:!0}),my(r,i*mb,{colours:!0,depthFunc:6})].map(e=>new Oi(s,e));for(let e of c)e.renderOrder=1;this.shown.set(e,c),this.group.add(...c)}clear(){for(let e of[...this.shown.keys()])this.set(e,null,[1,1,1],``)}};function bb(e,t,n,r){let i=Sb(e.low,e.high,t,n);if(!i)return;let{t:a,axis:o}=i,s=[0,0,0],c=[1/0,1/0,1/0],l=[1,1,1];for(let r=0;r<3;r++){let i=n[r],u=t[r]+a*i;s[r]=Math.min(Math.max(Math.floor(u),e.low[r]),e.high[r]-1),r===o&&(s[r]=i>0?e.low[r]:e.high[r]-1),l[r]=i>0?1:-1,i!==0&&(c[r]=(s[r]+ +(i>0)-t[r])/i)}o<0&&(o=xb(n));let u=n[o]>0?o+3:o;for(;;){if(r(s,u,a)||(o=c[0]<=c[1]?c[0]<=c[2]?0:2:c[1]<=c[2]?1:2,a=c[o],s[o]+=l[o],s[o]<e.low[o]||s[o]>=e.high[o]))return;c[o]=(s[o]+ +(l[o]>0)-t[o])/n[o],u=l[o]>0?o+3:o}}function xb(e){let[t,n,r]=e.map(Math.abs);return t>=n&&t>=r?0:n>=r?1:2}function Sb(e,t,n,r){let i=0,a=1/0,o=-1;for(let s=0;s<3;s++){if(t[s]<=e[s])return null;let c=r[s];if(c===0){if(n[s]<e[s]||n[s]>=t[s])return null;continue}let l=(e[s]-n[s])/c,u=(t[s]-n[s])/c;Math.min(l,u)>i&&(i=Math.min(l,u),o=s),a=Math.min(a,Math.max(l,u))}return a<i?null:{t:i,axis:o}}function Cb(e,t,n,r){let{labels:i,shape:a}=e,o=null;return bb(t,n,r,(e,n,r)=>{let s=(e[0]*a[1]+e[1])*a[2]+e[2],c=i[s];return!$_(c)||!t.visible[c]?!1:(o={cell:[...e],flat:s,face:n,t:r},!0)}),o}function wb([e,t],n){let r=!1;for(let i=0,a=n.length-1;i<n.length;a=i++){let[o,s]=n[i],[c,l]=n[a];s>t!=l>t&&e<(c-o)*(t-s)/(l-s)+o&&(r=!r)}return r}function Tb(e,t,n,r,i,a){if(r===`through`)return Db(e,t,n,i);let{labels:o,shape:s}=e,c=r===`surface`?0:r,l=new Set,[u,d]=Ob(n);for(let e=u[1]+Eb/2;e<d[1];e+=Eb)for(let r=u[0]+Eb/2;r<d[0];r+=Eb){if(!wb([r,e],n))continue;let{from:i,direction:u}=a(r,e),d=c;bb(t,i,u,e=>{let n=(e[0]*s[1]+e[1])*s[2]+e[2],r=o[n];return!$_(r)||!t.visible[r]?!1:(l.add(n),d--<=0)})}return[...l].sort((e,t)=>e-t)}var Eb=2;function Db({labels:e,shape:t},n,r,i){let a=[],[o,s]=Ob(r);for(let c=n.low[0];c<n.high[0];c++)for(let l=n.low[1];l<n.high[1];l++)for(let u=n.low[2];u<n.high[2];u++){let d=(c*t[1]+l)*t[2]+u,f=e[d];if(!$_(f)||!n.visible[f])continue;let p=i([c+.5,l+.5,u+.5]);!p||p[0]<o[0]||p[1]<o[1]||p[0]>s[0]||p[1]>s[1]||wb(p,r)&&a.push(d)}return a}function Ob(e){let t=e.map(([e])=>e),n=e.map(([,e])=>e);return[[Math.min(...t),Math.min(...n)],[Math.max(...t),Math.max(...n)]]}var kb=class{store;sight;seen;picker=null;labels=new Uint8Array;constructor(e,t,n){this.store=e,this.sight=t,this.seen=n}inCells(e){let{origin_m:t,voxel_m:n}=this.store.get().scene;return e.map((e,r)=>(e-t[r])/n)}pick(e,t){let{scene:n,instance:r}=this.store.get();if(!n||!this.labels.length)return null;let{from:i,direction:a}=this.sight.ray(e,t);if(this.picker)return this.picker({from:i,direction:a});let o=a.map(e=>e/n.voxel_m),s=Cb({labels:this.labels,shape:n.shape},this.seen(),this.inCells(i),o);if(!s)return null;let c=r[s.flat];return c?{...s,object:c}:s}pointAt(e,t){let n=this.pick(e,t);if(!n)return null;let{from:r,direction:i}=this.sight.ray(e,t);return r.map((e,t)=>e+n.t*i[t])}toRoom(e,t,n){let{from:r,direction:i}=this.sight.ray(e,t),a=(n.at-r[n.axis])/i[n.axis];return!Number.isFinite(a)||a<0?null:r.map((e,t)=>e+a*i[t])}lasso(e,t){let{scene:n}=this.store.get();if(!n||!this.labels.length||e.length<3)return[];let{origin_m:r,voxel_m:i,shape:a}=n,o=this.sight.projector();return Tb({labels:this.labels,shape:a},this.seen(),e,t,e=>o(e.map((e,t)=>r[t]+e*i)),(e,t)=>{let{from:n,direction:r}=this.sight.ray(e,t);return{from:this.inCells(n),direction:r}})}isCovered(e){let{scene:t,instance:n}=this.store.get(),r=this.sight.project(e);if(!t||!this.labels.length||!r)return!1;let{from:i,direction:a}=this.sight.ray(...r),o=a.map(e=>e/t.voxel_m),[s,c]=[this.inCells(i),this.inCells(e)],l=n[Z_(t.shape,...c.map(Math.floor))],u=Math.hypot(...c.map((e,t)=>e-s[t]))/Math.hypot(...o),d=this.seen(),f=!1;return bb(d,s,o,(e,r,i)=>{let a=Z_(t.shape,...e),o=this.labels[a];return f=i<u&&$_(o)&&d.visible[o]&&n[a]!==l,f||i>=u}),f}},Ab=.12,jb={dark:1447965,light:15856372},Mb=class extends Oy{canvas;store;onFrame=[];controls;scene=new or;renderer;material=new fb;chunks=new Gv(this.material,()=>this.invalidate());look=new Cy(this.material,this.chunks,new ry(this.material,()=>this.refresh()),new Ov(this.chunks.group,this.material));markers=new cb;ground=new vy;overlays=new yb;reach;compass;frames;glass;copy=new Uint8Array;place=``;size=``;work=``;drawn={scale:1,coarse:0};ends;constructor(e,t){super(),this.canvas=e,this.store=t,this.renderer=new Zl({canvas:e,antialias:!1}),this.renderer.debug.checkShaderErrors=!1,this.frames=new oy(new Rv,(...e)=>this.paint(...e)),this.glass=new ly(this.renderer),this.scene.add(this.ground.lines,this.chunks.group,this.overlays.group,this.markers.group),this.reach=new kb(t,this.sight,()=>this.look.seen),this.compass=new ey(e,e=>this.lookFrom(e)),this.controls=new hf(e,this),this.controls.claims=()=>t.get().tool!==`navigate`,this.warm();let n=new ResizeObserver(()=>this.invalidate());n.observe(e),e.addEventListener(`webglcontextrestored`,()=>this.invalidate()),this.ends=[()=>n.disconnect(),t.watch([`scene`,`labels`,`view`,`theme`],(e,t)=>{(t.has(`scene`)||t.has(`labels`))&&this.takeVolume(e),this.takeTheme(e),this.refresh()}),t.watch([`objects`,`selectedObjects`,`mode`,`view`,`theme`,`scene`],e=>{this.markers.take(e),this.invalidate()})]}get picker(){return this.reach.picker}set picker(e){this.reach.picker=e}pick(e,t){return this.measure(),this.reach.pick(e,t)}pointAt(e,t){return this.measure(),this.reach.pointAt(e,t)}toRoom(e,t,n){return this.measure(),this.reach.toRoom(e,t,n)}cellsInRect(e,t,n,r,i=`surface`){return this.lasso([[e,t],[n,t],[n,r],[e,r]],i)}lasso(e,t=`surface`){return this.measure(),this.reach.lasso(e,t)}setOverlay(e,t,n=`#ffffff`,r){let{scene:i}=this.store.get();i&&this.overlays.set(e,t,i.shape,n,r),this.invalidate()}showCells(e){this.chunks.group.visible=e,this.overlays.group.visible=e,this.invalidate()}setDifference(e){this.look.fields.setDifference(e,this.copy.length),this.setOverlay(`removed`,e?.removed??null,`#ff5d5d`),this.refresh()}invalidate(){this.frames.invalidate()}idle(){return this.frames.idle()}stats(){let{quads:e,bytes:t,made:n}=this.chunks;return{quads:e,bytes:t,made:n,ms:this.frames.lastMs,drawn:this.drawn}}dispose(){for(let e of this.ends)e();for(let e of[this.frames,this.glass,this.compass,this.markers,this.ground,this.controls,this.chunks,this.material,this.renderer])e.dispose()}takeVolume({scene:e,labels:t}){if(!e||t.length!==e.shape.reduce((e,t)=>e*t,1))return;let{shape:n,voxel_m:r,origin_m:i}=e,a=[e.name,r,...i,...n].join();if(a===this.place){let e=ev(this.copy,t);if(!e.length)return;this.chunks.touch(e),this.look.forget();return}this.place=a,this.copy=this.reach.labels=t.slice(),this.material.setPlace(r,i,n),this.overlays.setPlace(r,i),this.overlays.clear(),this.look.forget(),this.chunks.load(this.copy,n,r,i);let{low:o,high:s}=this.box();this.sight.orbit=cu(Dy,o,s,this.measure().aspect)}warm(){this.material.setParts({edges:!0,shadows:!0,opacity:1,by:`class`});let e=Sv([0,0,0],{words:new Uint32Array(8),starts:[]},Cv(1),this.material.greedy);e.geometry.addGroup(0,6,0),e.frustumCulled=!1,this.renderer.render(new or().add(e),this.sight.camera()),e.geometry.dispose()}refresh(){this.look.take(this.store.get(),this.copy),this.invalidate()}takeTheme({theme:e}){this.scene.background=new X(jb[e]);let t=this.box();t&&this.ground.take(t.low,t.high,e===`dark`)}paint(e,t,n){let r=this.store.get().view.opacity<1&&this.chunks.group.visible,i=r&&n!==null?{scale:1,coarse:0}:e;this.drawn=i,this.sight.step(t),this.resize(i.scale);let a=this.sight.camera();this.copy.length&&this.store.get().scene&&(this.aim(a,i.coarse),this.markers.dim(e=>this.reach.isCovered(e))),this.compass.turn(this.sight.pose||!this.copy.length?null:this.sight.axes),r&&n!==null?this.addPass(n,a):this.renderer.render(this.scene,a);let o=[this.renderer.info.programs?.length,this.chunks.made,i.scale].join(),s=o===this.work;this.work=o,this.copy.length&&Nb(`scene-first`),this.copy.length&&this.chunks.settled&&Nb(`scene-whole`);for(let e of[...this.onFrame])e(this.frames.lastMs);return{again:this.sight.flying,settled:this.chunks.settled,usual:s,more:r&&n!==7}}addPass(e,t){this.material.uniforms.grain.value=e,this.markers.group.visible=!1,this.glass.add(e,this.scene,t),this.material.uniforms.grain.value=0,this.markers.group.visible=!0,this.renderer.autoClear=!1,this.renderer.render(this.markers.group,t),this.renderer.autoClear=!0}aim(e,t){let{voxel_m:n}=this.store.get().scene,r=new Y().multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse);this.material.setOverlap(Ab/this.sight.pixels(1)/n,this.sight.isParallel),this.chunks.aim({eye:this.sight.isParallel?null:this.reach.inCells(this.sight.eye),direction:this.sight.axes.back.map(e=>-e),frustum:new Wi().setFromProjectionMatrix(r.multiply(this.chunks.group.matrix)),pixels:e=>this.sight.pixels(e*n)*n,coarse:t})}resize(e){let{clientWidth:t,clientHeight:n}=this.canvas;this.measure();let r=Math.min(devicePixelRatio*e,Math.max(devicePixelRatio,2)),i=[t,n,r].join();i!==this.size&&(this.size=i,this.renderer.setDrawingBufferSize(t,n,r),this.markers.resize(t,n))}};function Nb(e){performance.getEntriesByName(e).length||performance.mark(e)}var Pb=class{corners;length;ends;constructor(e){this.corners=e;let t=0;this.ends=e.map((n,r)=>t+=r?Ib(n,e[r-1]):0),this.length=t}at(e){let t=this.ends.findIndex(t=>t>=e),n=t<0?this.corners.length-1:Math.max(t,1),[r,i]=[this.corners[n-1],this.corners[n]??this.corners[n-1]],a=Ib(r,i),o=a?Math.min(Math.max((e-this.ends[n-1])/a,0),1):1;return{place:r.map((e,t)=>e+(i[t]-e)*o),yawDeg:Fb(r,i)}}crumbs(e){return Array.from({length:Math.floor(this.length/e)},(t,n)=>this.at((n+.5)*e).place)}};function Fb(e,t){return Math.atan2(e[0]-t[0],t[2]-e[2])*180/Math.PI}function Ib(e,t){return Math.hypot(e[0]-t[0],e[1]-t[1],e[2]-t[2])}var Lb=1.5,Rb=2,zb=.15,Bb=.5,Vb=220,Hb=.18,Ub=10,Wb=.5,Gb=class{route;goal;cellsPerMetre;gone=0;pace=0;constructor(e,t,n){this.route=e,this.goal=t,this.cellsPerMetre=n}get hasArrived(){return this.gone>=this.route.length}pass(e,t){let n=t/1e3,r=(this.route.length-this.gone)/this.cellsPerMetre,i=Math.sqrt(4*r);this.pace=Math.max(Math.min(this.pace+Rb*n,Lb,i),zb),this.gone=Math.min(this.gone+this.pace*this.cellsPerMetre*n,this.route.length);let{place:a}=this.route.at(this.gone),o=this.route.at(this.gone+Bb*this.cellsPerMetre).place,s=this.hasArrived||r<Bb?this.goal:o,c=Kb(e.yawDeg,Fb(a,s)),l=Vb*n,u=c*(1-Math.exp(-n/Hb)),d=e.pitchDeg+(Ub-e.pitchDeg)*(1-Math.exp(-n/(2*Hb)));return e.put(a,e.yawDeg+Math.min(Math.max(u,-l),l),d),this.hasArrived&&Math.abs(c)<Wb}};function Kb(e,t){return((t-e+180)%360+360)%360-180}var qb=1.2,Jb=120;async function Yb(){let e=await fetch(`api/agents`);return e.ok?(await e.json()).agents:[]}function Xb(e){return e.replace(/^https?:\/\/([^/]+).*$/,`$1`)}async function Zb(e,t){let n=await fetch(`api/agents/${e}`,{method:`POST`,headers:{"Content-Type":`application/json`},body:JSON.stringify(t)}),r=await n.json();if(!n.ok)throw Error(r.error);return r}var Qb=class{next=0;stands;constructor(e,t){this.stands=t.map(({feet_m:t,ahead_m:n})=>{let r=e.blocksOf(t);return{place:r,yawDeg:Fb(r,e.blocksOf(n))}})}pass(e,t){for(let n=t/1e3;this.next<this.stands.length&&n>0;){let{place:t,yawDeg:r}=this.stands[this.next],i=e.body.position,a=Math.hypot(...t.map((e,t)=>e-i[t]))/e.scale,o=Kb(e.yawDeg,r),s=Math.max(a/qb,Math.abs(o)/Jb),c=s>n?n/s:1,l=i.map((e,n)=>e+(t[n]-e)*c);e.put(l,e.yawDeg+o*c,e.pitchDeg*(1-c)),n-=s,c===1&&(this.next+=1)}return this.next===this.stands.length}},$b={pass:()=>!1},ex=[`lamp`,`sofa`,`bed`,`desk`,`oven`,`table`],tx=class{words;node;input;names=c(`datalist`,{id:`go-names`});said=c(`div`,{class:`go-said`,role:`status`});who;example=``;constructor(e,t){this.words=e,this.input=c(`input`,{class:`go-input`,type:`text`,name:`goal`,autocomplete:`off`,enterkeyhint:`go`,maxlength:120,list:this.names.id,placeholder:e.label,"aria-label":e.label});let n=c(`button`,{class:`button is-main go-send`,type:`submit`},e.go);this.who=c(`select`,{class:`go-who`,name:`who`,hidden:!0,"aria-label":e.who??``});let r=c(`form`,{class:`go-form`},Cd(`search`),this.input,this.who,n,this.names);r.addEventListener(`submit`,e=>{e.preventDefault(),t(this.input.value.trim()||this.example),this.input.blur()}),this.node=c(`div`,{class:`go`},r,this.said)}offer(e){let t=ex.find(t=>e.includes(t))??e[0];this.example=t?this.words.hint(t):``,this.input.placeholder=this.example||this.words.label,u(this.names,...[...new Set(e)].map(e=>c(`option`,{value:e})))}offerAgents(e,t){let{words:n}=this,r=e.map(e=>c(`option`,{value:e,title:n.agentHint?.(t(e))??``},t(e)));u(this.who,c(`option`,{value:``},n.planner??``),...r),this.who.hidden=!e.length}get agent(){return this.who.value}focus(){this.input.focus(),this.input.select()}say(e,...t){u(this.said,e,...t)}};function nx(e,t){return c(`span`,{class:`go-nears`},...e.map(e=>c(`button`,{class:`button go-near`,type:`button`,on:{click:()=>t(e)}},e)))}function rx(e,t,r){let i=n.walk.ask,a=new tx(i,e=>void l(e)),o=c(`div`,{class:`walk-ask glass`,hidden:!0},a.node);e.append(o);let s=0,l=async e=>{let{walker:t}=r;if(!e)return a.say(i.nothing);if(!t)return a.say(i.soon);let n=++s;if(r.lead(null),a.agent){await d(a.agent,e,()=>n===s&&r.isOn).catch(e=>{r.lead(null),a.say(e instanceof Error?e.message:String(e))});return}a.say(i.looking);let o=await ix(e,t.feet,r.size).catch(e=>String(e instanceof Error?e.message:e));n===s&&r.isOn&&(typeof o==`string`?a.say(o):u(o))},u=({thing:e,subject:n,near:o,of:s,away_m:c,corners_m:u})=>{if(!e)return a.say(i.unknown(n??``),o?.length?nx(o,e=>void l(e)):null);if(!u)return a.say(i.noWay(e.name));t.selection.objects([e.id]),a.say(i.walking(e.name,c??0,s??1)),r.lead({way:t=>new Gb(new Pb(u.map(e=>t.blocksOf(e))),t.blocksOf(e.center_m),t.scale),arrived:()=>a.say(i.arrived(e.name)),broken:()=>a.say(``)})},d=async(e,n,o)=>{let{walker:s,size:c}=r;if(!s)return;let l=Xb(e),u=!1,d=()=>{u=!0,a.say(``)},f=()=>r.lead({way:()=>$b,arrived:()=>void 0,broken:d}),p=()=>o()&&!u;f(),a.say(i.deciding(l,1,``));let{walk:m}=await Zb(`walk`,{agent:e,to:n,feet_m:s.feet,look_m:s.pose.forward,blocks_per_metre:c});for(let e=2;p();e+=1){let n=await Zb(`step`,{walk:m});if(!p())return;let o=i.cost(n.usd,n.calls),s=n.thought?i.thought(n.thought):``;if(await new Promise(t=>{r.lead({way:e=>new Qb(e,n.stances),arrived:t,broken:()=>(d(),t())}),a.say(i.deciding(l,e,o)+s)}),!p())return;if(n.end){let{goal:e}=n;e&&t.selection.objects([e.id]),a.say(i.agentEnd[n.end](l)+(e?i.agentGoal(e.name,e.away_m):``)+`${o}.`+s);return}f()}};Yb().then(e=>a.offerAgents(e,Xb),()=>void 0),t.store.watch([`mode`,`objects`],({mode:e,objects:t})=>{o.hidden=e!==`walk`,e===`walk`?a.offer([...t.values()].map(({title:e})=>e).sort()):a.say(``)}),t.actions.on(`walk.ask`,{run:()=>{t.store.set({mode:`walk`}),a.focus()},why:()=>t.store.get().scene?``:n.why.noScene})}async function ix(e,t,n){let r=new URLSearchParams({to:e,feet_m:t.map(e=>e.toFixed(3)).join(),blocks_per_metre:String(n)}),i=await fetch(`api/way?${r.toString()}`),a=await i.json();if(!i.ok)throw Error(a.error);return a}var ax=.6,ox=1.8,sx=1.5,cx=1.62,lx=1.27,ux=.6,dx=.08,fx=.98,px=.42,mx=.2,hx=.1,gx=.02,_x=1.3,vx=.3,yx=.98,bx=.91,xx=.6*bx,Sx=1e-7,Cx=.05,wx={forward:!1,back:!1,left:!1,right:!1,jump:!1,sneak:!1,sprint:!1};function Tx(e){return{position:e,velocity:[0,0,0],onGround:!1,crouched:!1,jumpWait:0,hitWall:!1}}function Ex([e,t,n],r,i){let a=ax*r/2,o=(i?sx:ox)*r;return[e-a,t,n-a,e+a,t+o,n+a]}function Dx(e,t){return(e.crouched?lx:cx)*t}var Ox={KeyW:`forward`,KeyS:`back`,KeyA:`left`,KeyD:`right`,Space:`jump`,ShiftLeft:`sneak`,ShiftRight:`sneak`,KeyR:`sprint`},kx={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,-1],ArrowDown:[0,1]},Ax=110,jx=.15,Mx=300,Nx=class{canvas;calls;extra;down=new Set;lastForward=-1/0;runs=!1;turned=[0,0];ends=[];constructor(e,t,n=null){this.canvas=e,this.calls=t,this.extra=n}start(){this.on(window,`keydown`,e=>this.press(e)),this.on(window,`keyup`,e=>this.release(e.code)),this.on(window,`blur`,()=>this.clear()),this.on(document,`pointerlockchange`,()=>this.lockChanged()),this.on(document,`mousemove`,e=>this.move(e)),this.on(this.canvas,`click`,()=>void this.lock())}stop(){for(let e of this.ends.splice(0))e();this.isLocked&&document.exitPointerLock(),this.clear()}get isLocked(){return document.pointerLockElement===this.canvas}get isHeld(){return this.down.size>0}get keys(){let e={...wx};for(let t of this.down)Ox[t]&&(e[Ox[t]]=!0);e.sprint||=this.runs&&e.forward;let t=this.extra?.keys??wx;for(let n of Object.keys(e))e[n]||=t[n];return e}look(e){let[t,n]=this.turned;this.turned=[0,0];let r=Ax*e/1e3,[i,a]=this.extra?.look()??[0,0],[o,s]=[t+i,n+a];for(let e of this.down)o+=(kx[e]?.[0]??0)*r,s+=(kx[e]?.[1]??0)*r;return[o,s]}press(e){e.code===`Escape`?(e.preventDefault(),this.calls.leave()):e.ctrlKey||e.metaKey||e.altKey||Px(e.target)||(Ox[e.code]||kx[e.code])&&(e.preventDefault(),e.repeat||(e.code===`KeyW`&&(this.runs=e.timeStamp-this.lastForward<Mx,this.lastForward=e.timeStamp),this.down.add(e.code),this.calls.moved()))}release(e){this.down.delete(e),e===`KeyW`&&(this.runs=!1)}clear(){this.down.clear(),this.runs=!1}move(e){this.isLocked&&(this.turned[0]+=e.movementX*jx,this.turned[1]+=e.movementY*jx,this.calls.moved())}async lock(){try{await this.canvas.requestPointerLock()}catch{}}lockChanged(){!this.isLocked&&document.hasFocus()&&this.calls.leave()}on(e,t,n){let r=n;e.addEventListener(t,r,{capture:!0}),this.ends.push(()=>e.removeEventListener(t,r,{capture:!0}))}};function Px(e){return e instanceof HTMLElement&&e.closest(`input:not([type=checkbox]), select, textarea`)!==null}var Fx=.28,Ix=.98,Lx=.32,Rx=9,zx=400,Bx=[[`right`],[`right`,`back`],[`back`],[`back`,`left`],[`left`],[`left`,`forward`],[`forward`],[`forward`,`right`]];function Vx(e,t){let n={...wx},r=Math.hypot(e,t);if(r<Fx)return n;let i=(Math.round(Math.atan2(t,e)*4/Math.PI)+8)%8;for(let e of Bx[i])n[e]=!0;return n.sprint=n.forward&&r>=Ix,n}var Hx=class{node;held=wx;jumps=!1;turned=[0,0];constructor(e,t){let n=c(`div`,{class:`thumb-knob`}),r=c(`div`,{class:`thumb-stick`,role:`img`,"aria-label":e.stick},n),i=c(`div`,{class:`thumb-pad`,role:`img`,"aria-label":e.look}),a=c(`button`,{class:`thumb-jump`,type:`button`,"aria-label":e.jump},`↑`);this.node=c(`div`,{class:`thumbs`},i,r,a),Ux(r,{move:({x:e,y:i})=>{let a=r.getBoundingClientRect(),[o,s]=[(e-a.left)/a.width,(i-a.top)/a.height].map(e=>2*e-1),c=Math.max(Math.hypot(o,s),1);this.held=Vx(o/c,s/c),n.style.setProperty(`transform`,`translate(${o/c*70}%, ${s/c*70}%)`),t.moved()},end:()=>{this.held=wx,n.style.removeProperty(`transform`)}}),this.followPad(i,t);let o=e=>()=>{this.jumps=e,t.moved()};for(let[e,t]of[[`pointerdown`,!0],[`pointerup`,!1],[`pointercancel`,!1],[`pointerleave`,!1]])a.addEventListener(e,o(t))}get keys(){return{...this.held,jump:this.jumps}}look(){let e=this.turned;return this.turned=[0,0],e}followPad(e,t){let[n,r,i]=[{x:0,y:0},0,0];Ux(e,{start:e=>{[n,r,i]=[e,performance.now(),0]},move:e=>{this.turned[0]+=(e.x-n.x)*Lx,this.turned[1]+=(e.y-n.y)*Lx,i+=Math.hypot(e.x-n.x,e.y-n.y),n=e,t.moved()},end:()=>{i<Rx&&performance.now()-r<zx&&t.tapped(n.x,n.y)}})}};function Ux(e,t){let n=-1,r=e=>e.pointerId===n,i=e=>({x:e.clientX,y:e.clientY});e.addEventListener(`pointerdown`,r=>{if(!(n>=0)){n=r.pointerId;try{e.setPointerCapture(n)}catch{}r.preventDefault(),t.start?.(i(r)),t.start||t.move(i(r))}}),e.addEventListener(`pointermove`,e=>r(e)&&t.move(i(e)));for(let i of[`pointerup`,`pointercancel`])e.addEventListener(i,e=>{r(e)&&(n=-1,t.end())})}var Wx=[[1,2],[0,2],[0,1]];function Gx(e,t,n=Sx){return e.some(e=>Xx(e,t,0,n)&&Xx(e,t,1,n)&&Xx(e,t,2,n))}function Kx(e,t,n,r,i=Sx){let[a,o]=Wx[n],s=r;for(let c of r===0?[]:e)if(Xx(c,t,a,i)&&Xx(c,t,o,i)){if(r>0){let e=c[n]-t[n+3];e>=-i&&e<s&&(s=e)}else{let e=c[n+3]-t[n];e<=i&&e>s&&(s=e)}}return s}function qx(e,t,n,r=Sx){let i=Math.abs(n[0])<Math.abs(n[2])?[1,2,0]:[1,0,2],a=[0,0,0],o=[...t];for(let t of i)a[t]=Kx(e,o,t,n[t],r),o[t]+=a[t],o[t+3]+=a[t];return a}function Jx(e,t,n,r,i=Sx){let a=qx(e,t,[n[0],r,n[2]],i),o=Kx(e,[t[0]+Math.min(n[0],0),t[1],t[2]+Math.min(n[2],0),t[3]+Math.max(n[0],0),t[4],t[5]+Math.max(n[2],0)],1,r,i);if(o<r){let[r,,s]=qx(e,Yx(t,[0,o,0]),[n[0],0,n[2]],i);r*r+s*s>a[0]*a[0]+a[2]*a[2]&&(a=[r,o,s])}let s=Kx(e,Yx(t,a),1,n[1]-a[1],i);return[a[0],a[1]+s,a[2]]}function Yx(e,[t,n,r]){return[e[0]+t,e[1]+n,e[2]+r,e[3]+t,e[4]+n,e[5]+r]}function Xx(e,t,n,r){let i=n+3;return e[n]<t[i]-r&&e[i]>t[n]+r}var Zx=1;function Qx(e,t,n,r,i){let a=$x(e,t,i),o=Sx*i,s=!t.crouched||!Gx(a,Ex(t.position,i,!1),o),c=n.sneak||!s,l=n.sprint&&n.forward&&!n.back&&!c,u=t.velocity.map(e=>Math.abs(e)>=.003*i?e:0);t.onGround&&(u[1]=-dx*fx*i);let d=n.jump?Math.max(t.jumpWait-1,0):0;n.jump&&t.onGround&&d===0&&(u[1]=px*i,d=10,tS(u,0,l?mx*i:0,r)),eS(u,t.onGround,n,c,l,r,i);let f=c&&t.onGround&&u[1]<=0?rS(a,t,u,i):[...u],p=nS(a,t,f,c,i),m=p.map((e,t)=>Math.abs(e-f[t])>o),h=t.onGround?xx:bx,g=m[1]?0:u[1];return{position:t.position.map((e,t)=>e+p[t]),velocity:[m[0]?0:u[0]*h,(g-dx*i)*fx,m[2]?0:u[2]*h],onGround:m[1]===!0&&f[1]<0,crouched:c,jumpWait:d,hitWall:m[0]===!0||m[2]===!0}}function $x(e,t,n){let r=Ex(t.position,n,!1),i=t.velocity.map(e=>Math.abs(e)+Zx*n);return e.near([r[0]-i[0],r[1]-i[1],r[2]-i[2]],[r[3]+i[0],r[4]+i[1],r[5]+i[2]])}function eS(e,t,n,r,i,a,o){let s=yx*(r?vx:1),c=(Number(n.forward)-Number(n.back))*s,l=(Number(n.left)-Number(n.right))*s,u=Math.hypot(c,l);if(u<.01)return;let d=(t?hx:gx)*o*(i?_x:1)/Math.max(u,1);tS(e,l*d,c*d,a)}function tS(e,t,n,r){let i=r*Math.PI/180,a=Math.sin(i),o=Math.cos(i);e[0]+=t*o-n*a,e[2]+=n*o+t*a}function nS(e,t,n,r,i){let a=Ex(t.position,i,r),o=Sx*i,s=qx(e,a,n,o),c=n[1]<0&&s[1]-n[1]>o;if(!(Math.abs(s[0]-n[0])>o||Math.abs(s[2]-n[2])>o)||!(t.onGround||c))return s;let l=Jx(e,a,n,ux*i,o);return l[0]**2+l[2]**2>s[0]**2+s[2]**2+o**2?l:s}function rS(e,t,n,r){let i=Ex(t.position,r,!0),a=Cx*r,o=(t,n)=>!Gx(e,Yx(i,[t,-ux*r,n]),Sx*r),[s,,c]=n;for(;s&&o(s,0);)s=iS(s,a);for(;c&&o(0,c);)c=iS(c,a);for(;s&&c&&o(s,c);)[s,c]=[iS(s,a),iS(c,a)];return[s,n[1],c]}function iS(e,t){return Math.abs(e)<=t?0:e-Math.sign(e)*t}var aS=1,oS=class e{kinds;shape;shapes;constructor(e,t,n){this.kinds=e,this.shape=t,this.shapes=n}static of(t){let{values:n}=t.array(`boxes`),{values:r}=t.array(`starts`),{values:i,shape:a}=t.array(`kinds`),o=Array.from({length:r.length-1},(e,t)=>Array.from({length:r[t+1]-r[t]},(e,i)=>{let a=6*(r[t]+i);return Array.from(n.slice(a,a+6))}));return new e(i,a,o)}near(e,t){let[n,r,i]=this.first(e),[a,o,s]=this.last(t),c=[];for(let e=n;e<a;e++)for(let t=r;t<o;t++)for(let n=i;n<s;n++){let r=this.kinds[(e*this.shape[1]+t)*this.shape[2]+n];if(r)for(let i of this.shapes[r])c.push([i[0]+e,i[1]+t,i[2]+n,i[3]+e,i[4]+t,i[5]+n])}return c}first(e){return e.map((e,t)=>this.within(Math.floor(e)-(t===1?aS:0),t))}last(e){return e.map((e,t)=>this.within(Math.floor(e)+1,t))}within(e,t){return Math.min(Math.max(e,0),this.shape[t])}},sS=50,cS=10,lS=70*Math.PI/180,uS=89,dS=[.02,.1,.25,.6,1.2],fS=200,pS=class{keys=wx;yawDeg;pitchDeg=8;body;before;rest=0;scale;rev;world;start;toRoom;constructor(e){let t=e.told;this.world=oS.of(e),this.scale=t.blocks_per_metre,this.rev=t.rev,this.start=t.feet,this.yawDeg=t.yaw_deg,this.toRoom=new Y().fromArray(t.grid_to_room).transpose(),this.body=this.before=Tx(t.feet)}look(e,t){this.yawDeg+=e,this.pitchDeg=Math.min(Math.max(this.pitchDeg+t,-89),uS)}pass(e){let t=this.isStill;for(this.rest=Math.min(this.rest+e,cS*sS);this.rest>=sS;)this.rest-=sS,this.before=this.body,this.body=Qx(this.world,this.body,this.keys,this.yawDeg,this.scale),this.start[1]-this.body.position[1]>fS&&(this.body=this.before=Tx(this.start));return!t||!this.isStill}standAt(e){let[t,n,r]=this.blocksOf(e.feet),i=e=>Ex([t,n+e*this.scale,r],this.scale,!1),a=e=>!Gx(this.world.near([e[0],e[1],e[2]],[e[3],e[4],e[5]]),e),o=dS.find(e=>a(i(e)));o!==void 0&&(this.body=this.before=Tx([t,n+o*this.scale,r])),[this.yawDeg,this.pitchDeg]=[e.yawDeg,e.pitchDeg]}put(e,t,n){this.body=this.before={...Tx(e),onGround:!0},this.rest=0,[this.yawDeg,this.pitchDeg]=[t,n]}blocksOf(e){return new G(...e).applyMatrix4(this.toRoom.clone().invert()).toArray()}get isStill(){let{before:e,body:t}=this;return e.crouched===t.crouched&&e.position.every((e,n)=>e===t.position[n])}get feet(){return this.roomOf(this.body.position)}get pose(){let e=this.rest/sS,t=this.before.position.map((t,n)=>t+(this.body.position[n]-t)*e);return t[1]+=Dx(this.body,this.scale),{position:this.roomOf(t),forward:this.forward,up:[0,0,1],field:lS}}get forward(){let[e,t]=[this.yawDeg,this.pitchDeg].map(e=>e*Math.PI/180),n=Math.cos(t);return new G(-Math.sin(e)*n,-Math.sin(t),Math.cos(e)*n).transformDirection(this.toRoom).toArray()}roomOf(e){return new G(...e).applyMatrix4(this.toRoom).toArray()}},mS=250,hS=250,gS=class{app;walker=null;ground=`blocks`;thumbs=new Hx(n.walk.thumbs,{moved:()=>void 0,tapped:()=>void 0});input;view;back=`inspect`;frame=0;last=0;toldAt=0;behind=null;sky=new X;listeners=new Set;asked=0;led=null;constructor(e){this.app=e,this.view=e.view,this.input=new Nx(e.canvas,{leave:()=>this.app.store.set({mode:this.back}),moved:()=>this.take()},this.thumbs),e.store.watch([`mode`],({mode:e})=>{e!==`walk`&&(this.back=e)}),Wu(e).watch(()=>void this.renew()),e.store.watch([`touched`],()=>this.ground===`voxels`&&void this.renew())}watch(e){this.listeners.add(e)}get isOn(){return this.app.store.get().mode===`walk`}get size(){return Wu(this.app).loader.wish.size}lead(e){let{walker:t}=this;this.led=t&&e?{way:e.way(t),lead:e}:null}take(){let{led:e}=this;this.led=null,e?.lead.broken()}enter(){this.behind=this.view.scene.background,this.choose(this.ground),this.input.start(),document.activeElement?.blur(),this.last=performance.now(),this.frame=requestAnimationFrame(e=>this.pass(e))}leave(){cancelAnimationFrame(this.frame),this.input.stop(),this.walker=this.led=null,this.view.pose=null,this.view.scene.background=this.behind,Wu(this.app).show(!1)}choose(e){this.ground=e,Wu(this.app).show(e===`blocks`,!0),this.load(),this.tell()}async renew(){let{mesh:e,busy:t}=Wu(this.app).loader,n=this.ground===`blocks`?e?.facts.rev:this.app.store.get().scene?.rev,r=this.ground===`blocks`?e?.facts.blocks_per_metre:this.walker?.scale;this.isOn&&!t&&this.walker&&(this.walker.rev!==n||this.walker.scale!==r)&&await this.load()}async load(){let e=++this.asked,{size:t,style:n}=Wu(this.app).loader.wish,r=`what=build&blocks_per_metre=${t}&style=${n}`,i=await fetch(`api/collision?${this.ground===`blocks`?r:`what=voxels`}`);if(!i.ok){this.app.toast((await i.json()).error,`error`);return}let a=await i.arrayBuffer();if(e!==this.asked||!this.isOn)return;let o=new pS(ku.read(a,`W2MC`));this.walker&&o.standAt(this.walker),this.take(),this.walker=o,this.tell()}pass(e){this.frame=requestAnimationFrame(e=>this.pass(e));let t=e-this.last;this.last=e;let{walker:n}=this;n&&(this.showSky(),this.led?this.follow(this.led,n,t):this.steer(n,t),e-this.toldAt>hS&&(this.toldAt=e,this.tell()))}steer(e,t){let[n,r]=this.input.look(t);e.look(n,r),e.keys=this.input.keys,(e.pass(t)||n||r||!this.view.pose)&&(this.view.pose=e.pose,this.app.connection.active())}follow(e,t,n){let r=e.way.pass(t,Math.min(n,mS));this.view.pose=t.pose,this.app.connection.active(),r&&(this.led=null,e.lead.arrived())}showSky(){let e=vu[Wu(this.app).blocks.material.light];(this.view.scene.background!==this.sky||this.sky.getHex()!==e)&&(this.view.scene.background=this.sky.setHex(e),this.view.invalidate())}ahead(){let{pose:e}=this.view;if(!e||this.ground!==`blocks`)return``;let t=Wu(this.app).ahead(e.position,e.forward);if(!t)return``;let r=this.app.store.get().objects.get(t.object);return n.walk.ahead(Bu(t.state).name,r&&i(r))}tell(){for(let e of this.listeners)e()}},_S=new WeakMap;function vS(e){let t=_S.get(e)??new gS(e);return _S.set(e,t),t}function yS(){w(`walk`,{enter:e=>vS(e).enter(),leave:e=>vS(e).leave()}),T({id:`walk`,title:n.walk.title,place:`right`,modes:[`walk`],order:5,mount:bS}),E({id:`walking`,mount:xS})}function bS(e,t){let r=vS(t),i=g(n.walk.through,()=>[`blocks`,`voxels`].map(e=>({value:e,label:n.walk.grounds[e]})),e=>r.choose(e)),a=n.walk.keys.map(([e,t])=>c(`li`,{},c(`kbd`,{class:`key`},e),c(`span`,{},t)));e.append(i.node,c(`ul`,{class:`walk-keys`},...a)),r.watch(()=>i.set(r.ground)),i.set(r.ground)}function xS(e,t){let r=vS(t),i=c(`div`,{class:`walk-ahead`}),a=c(`div`,{class:`walk-hint`},n.walk.hint),o=c(`div`,{class:`walk-over`,hidden:!0},c(`div`,{class:`walk-cross`}),i,a);e.append(r.thumbs.node,o),rx(e,t,r),t.store.watch([`mode`],({mode:e})=>o.hidden=e!==`walk`),r.watch(()=>{r.isOn&&(u(i,r.ahead()),a.hidden=document.pointerLockElement===t.canvas)})}var SS=new tp,CS=document.querySelector(`#app`)??document.body.appendChild(c(`div`));$g(),Y_(),Gu(),yS(),Zf(),Qd(),gd(),Ed(),jd(),U_(CS,SS,e=>{try{return new Mb(e,SS)}catch(e){throw CS.replaceChildren(c(`p`,{class:`no-3d`,role:`alert`},n.error.noView)),e}}).then(e=>{let{view:t,connection:n}=e,r=Wu(e),i=vS(e);Object.assign(window,{__forge:{build:r,walk:i,store:SS,view:t,connection:n,app:e,idle:()=>t.idle()}})});